! The return map of the restitution model and its derivatives, for the map mode of AUTO-07p.
! U is the phase φ and the closing speed u before an impact, PAR(1) is Λ and PAR(2) is r. AUTO
! iterates the map PAR(11) times. The file "start" has Λ, r, the number of impacts, φ and u.
SUBROUTINE FUNC(NDIM, U, ICP, PAR, IJAC, F, DFDU, DFDP)
  IMPLICIT NONE
  INTEGER NDIM, IJAC, ICP(*), STEP
  DOUBLE PRECISION U(NDIM), PAR(*), F(NDIM), DFDU(NDIM, *), DFDP(NDIM, *)
  DOUBLE PRECISION LAMBDA, R, X, Y, X1, Y1, LAUNCH, T, LANDING, CHANGE, TU, TP, TL, TR
  LAMBDA = PAR(1)
  R = PAR(2)
  X = LAMBDA*COS(U(1))
  Y = LAMBDA*SIN(U(1))
  LAUNCH = X + R*U(2)
  ! Newton's method for the landing begins where the ball falls below the lowest table.
  T = LAUNCH + SQRT(LAUNCH**2 + 2*(LAMBDA + Y))
  DO STEP = 1, 50
    X1 = LAMBDA*COS(U(1) + T)
    Y1 = LAMBDA*SIN(U(1) + T)
    LANDING = T + X1 - LAUNCH
    CHANGE = (LAUNCH*T - T**2/2 + Y - Y1)/LANDING
    T = T + CHANGE
    IF (ABS(CHANGE) < 1D-8*T) EXIT
  END DO
  X1 = LAMBDA*COS(U(1) + T)
  Y1 = LAMBDA*SIN(U(1) + T)
  LANDING = T + X1 - LAUNCH
  F(1) = U(1) + T - 2*ACOS(-1D0)
  F(2) = LANDING
  IF (IJAC == 0) RETURN
  TP = (X - X1 - Y*T)/LANDING
  TU = R*T/LANDING
  DFDU(1, 1) = 1 + TP
  DFDU(1, 2) = TU
  DFDU(2, 1) = TP - Y1*(1 + TP) + Y
  DFDU(2, 2) = TU*(1 - Y1) - R
  IF (IJAC == 1) RETURN
  TL = (X*T + Y - Y1)/(LAMBDA*LANDING)
  TR = U(2)*T/LANDING
  DFDP(1, 1) = TL
  DFDP(2, 1) = TL*(1 - Y1) + (X1 - X)/LAMBDA
  DFDP(1, 2) = TR
  DFDP(2, 2) = TR*(1 - Y1) - U(2)
END SUBROUTINE FUNC

SUBROUTINE STPNT(NDIM, U, PAR, T)
  IMPLICIT NONE
  INTEGER NDIM
  DOUBLE PRECISION U(NDIM), PAR(*), T
  OPEN(77, FILE='start')
  READ(77, *) PAR(1), PAR(2), PAR(11), U
  CLOSE(77)
END SUBROUTINE STPNT

! AUTO links these routines and does not call them here.
SUBROUTINE BCND
END SUBROUTINE BCND

SUBROUTINE ICND
END SUBROUTINE ICND

SUBROUTINE FOPT
END SUBROUTINE FOPT

SUBROUTINE PVLS
END SUBROUTINE PVLS
