! The orbits of the restitution model with two impacts, for AUTO-07p: the height and the velocity at
! the end of each flight. U holds the phases and the velocities relative to the table before the
! impacts; PAR holds the amplitude and the restitution coefficient. The file "start" has an orbit.
SUBROUTINE FUNC(NDIM, U, ICP, PAR, IJAC, F, DFDU, DFDP)
  IMPLICIT NONE
  INTEGER NDIM, IJAC, ICP(*), LEG
  DOUBLE PRECISION U(NDIM), PAR(*), F(NDIM), DFDU(*), DFDP(*)
  DOUBLE PRECISION PHASE, THEN, AFTER, ALOFT, LAUNCH
  DO LEG = 0, 1
    PHASE = U(2*LEG + 1)
    IF (LEG == 0) THEN
      THEN = U(3)
      AFTER = U(4)
    ELSE
      THEN = U(1) + 4*ACOS(-1D0)
      AFTER = U(2)
    END IF
    ALOFT = THEN - PHASE
    LAUNCH = PAR(1)*COS(PHASE) - PAR(2)*U(2*LEG + 2)
    F(2*LEG + 1) = LAUNCH*ALOFT - ALOFT**2/2 + PAR(1)*(SIN(PHASE) - SIN(THEN))
    F(2*LEG + 2) = LAUNCH - ALOFT - PAR(1)*COS(THEN) - AFTER
  END DO
END SUBROUTINE FUNC

SUBROUTINE STPNT(NDIM, U, PAR, T)
  IMPLICIT NONE
  INTEGER NDIM
  DOUBLE PRECISION U(NDIM), PAR(*), T
  OPEN(77, FILE='start')
  READ(77, *) PAR(1), PAR(2), U
  CLOSE(77)
END SUBROUTINE STPNT

! AUTO asks for these routines and does not call them here.
SUBROUTINE BCND
END SUBROUTINE BCND

SUBROUTINE ICND
END SUBROUTINE ICND

SUBROUTINE FOPT
END SUBROUTINE FOPT

SUBROUTINE PVLS
END SUBROUTINE PVLS
