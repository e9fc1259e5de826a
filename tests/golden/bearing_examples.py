#!/usr/bin/env python3
"""The two worked examples of Ligterink and de Gee (1996) to 25 digits: bearing_examples.csv.

Evaluates their printed formulas with 120 digits, and once more as an integral of the overlap over
the angle, which shares nothing with them; stops when the two disagree. Needs mpmath
(apt install python3-mpmath).

    tests/golden/bearing_examples.py > tests/golden/bearing_examples.csv
"""
from circle_area import area, cos_beta
from mpmath import acos, cos, findroot, mp, mpf, nstr, pi, quad, sin, sqrt


def wear_number(sigma, delta):
    return area(sigma, delta) / (4 * pi)


def by_quadrature(sigma, delta):
    e, bushing = sigma + delta, 1 + sigma
    outer = lambda t: e * cos(t) + sqrt(1 - (e * sin(t)) ** 2)
    return quad(lambda t: outer(t) ** 2 - bushing**2, [0, acos(cos_beta(sigma, delta))]) / (4 * pi)


def depth(sigma, wanted):
    return findroot(lambda d: wear_number(sigma, d) - wanted, (sigma / 2, sigma), solver="anderson")


examples = [
    # r = 0.02 m, clearance 2e-5 m, depth 1e-4 m
    (mpf("1e-3"), mpf("5e-3"), wear_number(mpf("1e-3"), mpf("5e-3"))),
    # sigma = 20e-4, p_a = 2e6 N/m^2, n = 1e6, k = 1e-16 m^3/(N m)
    (mpf("2e-3"), depth(mpf("2e-3"), mpf("2e-4")), mpf("2e-4")),
]
print("sigma,delta,wear_number")
for sigma, delta, number in examples:
    assert abs(by_quadrature(sigma, delta) / number - 1) < mpf(10) ** -30
    print(",".join(nstr(x, 25, min_fixed=0, max_fixed=0) for x in (sigma, delta, number)))
