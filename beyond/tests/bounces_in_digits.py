"""The bounces of a ball before it comes to rest on the table, one by one."""

import mpmath


def summed(r, lam, phase, speed):
    """How long a ball bounces that leaves with a relative speed, bounce by bounce in 40 digits."""
    with mpmath.workdps(40):
        tau = mpmath.mpf(phase)
        u = mpmath.mpf(speed)
        time = mpmath.mpf(0)
        while u > 1e-20:

            def gap(s, tau=tau, u=u):
                table = mpmath.sin(tau + s) - mpmath.sin(tau) - s * mpmath.cos(tau)
                return u - s / 2 - lam * table / s

            s = mpmath.findroot(gap, 2 * u / (1 - lam * mpmath.sin(tau)))
            u = r * (s - u + lam * (mpmath.cos(tau + s) - mpmath.cos(tau)))
            tau += s
            time += s
        return float(time)
