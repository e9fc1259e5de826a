#!/usr/bin/env python3
"""Golden values of the lune (the part of one circle outside another): circle_area.csv.

Evaluates the formulas as Ligterink and de Gee (1996) print them, with 120 digits, so that their
cancellation does no harm; the derivatives are numerical ones of the printed area. Needs mpmath
(apt install python3-mpmath).

    tests/golden/circle_area.py > tests/golden/circle_area.csv
"""
import random

from mpmath import acos, diff, mp, mpf, nstr, sin, sqrt

mp.dps = 120


def cos_alpha(sigma, delta):
    return (2 * sigma - 2 * sigma * delta - delta**2) / (2 * (sigma + delta))


def cos_beta(sigma, delta):
    top = 2 * sigma + 2 * sigma**2 + 2 * sigma * delta + delta**2
    return top / (2 * (1 + sigma) * (sigma + delta))


def area(sigma, delta):
    alpha, beta = acos(cos_alpha(sigma, delta)), acos(cos_beta(sigma, delta))
    return (2 * alpha - sin(2 * alpha) - (1 + sigma) ** 2 * (2 * beta - sin(2 * beta))) / 2


def grid():
    sigmas = [1e-8, 1e-7, 1e-6, 1e-5, 2e-4, 5e-4, 1e-3, 2e-3, 1e-2, 5e-2, 0.1, 0.2, 0.35, 0.5]
    depths = [m * 10.0**e for e in range(-12, 0) for m in (1, 3)] + [0.5, 0.7, 0.9, 1.0]
    for sigma in sigmas:
        for delta in depths + [1.0000001, 1.5, 1.9, 1.999]:
            yield sigma, delta
    # Beyond the promised range: a tight fit, and a pin far smaller than its bushing.
    for sigma in (1e-12, 2.0, 50.0):
        for delta in (1e-12, 1e-6, 1e-2, 0.5, 1.0, 1.5):
            yield sigma, delta
    rng = random.Random(4)
    for _ in range(400):
        yield 10 ** rng.uniform(-8, -0.30103), 10 ** rng.uniform(-12, 0)


def main():
    print("sigma,delta,area,d_sigma,d_delta,alpha,beta,half_chord")
    for sigma, delta in grid():
        s, d = mpf(sigma), mpf(delta)  # exactly the doubles that the csv names
        row = [
            area(s, d),
            diff(lambda x: area(x, d), s, h=s * mpf(10) ** -40),
            diff(lambda x: area(s, x), d, h=d * mpf(10) ** -40),
            acos(cos_alpha(s, d)),
            acos(cos_beta(s, d)),
            sqrt(1 - cos_alpha(s, d) ** 2),
        ]
        print(",".join([repr(sigma), repr(delta)] + [nstr(x, 25, min_fixed=0, max_fixed=0) for x in row]))


if __name__ == "__main__":
    main()
