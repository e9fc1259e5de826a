#!/usr/bin/env python3
"""Golden values of the random fatigue limit's likelihood (Pascual and Meeker 1999): random_limit.csv.

Integrates the law as printed, over the logarithm of the limit, with 25 digits by tanh-sinh between breakpoints,
which are doubled to see that they are enough. Needs mpmath (Debian: python3-mpmath). Run from the project's root:
    python3 tests/golden/random_limit.py > tests/golden/random_limit.csv
"""
import itertools
from mpmath import mp, mpf, quad, log, exp, ncdf, npdf, expm1

mp.dps = 25


def density(law, z):
    return npdf(z) if law == "normal" else exp(z - exp(z))


def cdf(law, z):
    return ncdf(z) if law == "normal" else -expm1(-exp(z))


def survival(law, z):
    return ncdf(-z) if law == "normal" else exp(-exp(z))


def value(life, limit, outcome, at, until, x):
    s, a, b, sigma, location, scale = x
    def center(v):
        return (s + log(-expm1((v - s) * log(10))) / log(10) - a) / b
    def seen(v):
        c = center(v)
        z = (at - c) / sigma
        if outcome == "failure":
            return density(life, z) / sigma
        if outcome == "runout":
            return survival(life, z)
        if outcome == "left":
            return cdf(life, z)
        z2 = (until - c) / sigma
        return survival(life, z) - survival(life, z2) if z > 0 else cdf(life, z2) - cdf(life, z)
    def f(v):
        return density(limit, (v - location) / scale) / scale * seen(v)
    marks = set()
    for k in (-60, -25, -12, -7, -4, -2, -1, 0, 1, 2, 4, 7, 12):
        marks.add(location + k * scale)
    for y in {at, until if outcome == "interval" else at}:
        share = 1 - mpf(10) ** (a + b * y - s)
        if share > 0:
            top = s + log(share) / log(10)
            width = sigma * abs(b) * (1 - share) / share
            for k in (-20, -8, -4, -2, -1, 0, 1, 2, 4, 8):
                marks.add(top + k * width)
    # Towards the stress itself life grows without end.
    for k in (1, 2, 4, 8, 16):
        marks.add(s - mpf(10) ** -k)
    def integrate(per):  # panels per scale of the limit: far out the integrand has narrow features
        fine = {location + scale * mpf(k) / per for k in range(-25 * per, 10 * per)}
        return quad(f, sorted(m for m in marks | fine if m < s) + [s])
    per = 2 if location > s - 8 * scale else 80 if life == limit == "sev" else 20
    coarse, integral = integrate(per), integrate(2 * per)
    assert abs(integral - coarse) < mpf(10) ** -12 * integral, (coarse, integral)
    if outcome == "runout":
        integral += survival(limit, (s - location) / scale)
    return log(integral)


settings = {  # log10 S_f, log10 a, b, sigma, location, scale; lives
    "ordinary": (("8.4", "9.35", "-0.15", "0.3", "8.25", "0.06"), ("6.8", "7.6")),
    "narrow": (("8.4", "9.35", "-0.15", "0.02", "8.3", "0.004"), ("10.9", "11.2")),
    "low stress": (("8.2", "9.35", "-0.15", "0.2", "8.25", "0.05"), ("8.0", "9.5")),
    "far out": (("8.5", "9.35", "-0.15", "0.1", "8.0", "0.05"), ("9.0", "9.5")),
    "at the limit": (("8.5313", "8.7036", "-0.0318", "0.9725", "8.53128", "0.0795"), ("8.1006", "8.1441")),
}
print("case,life,limit,outcome,log10_reversed,log10_a,b,sigma,location,scale,at,until,value")
for (name, (numbers, lives)), life, limit, outcome in itertools.product(
        settings.items(), ("normal", "sev"), ("normal", "sev"), ("failure", "runout", "left", "interval")):
    x = [mpf(each) for each in numbers]
    at, until = (mpf(each) for each in lives)
    print(",".join([name, life, limit, outcome, *numbers, *lives, mp.nstr(value(life, limit, outcome, at, until, x), 17)]), flush=True)
