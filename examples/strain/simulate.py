"""tests.csv of this folder: python3 simulate.py. Standard library only.

Strain-controlled tests, fully reversed, of a steel: strain amplitude = sigma_f'/E (2N)^b + eps_f' (2N)^c with sigma_f'/E = 0.0046,
b = -0.09, eps_f' = 0.60, c = -0.59; log10 N scatters with a standard deviation of 0.12. Tests are stopped after 2e6 cycles.
"""
import math
import random

ELASTIC, B, PLASTIC, C, SIGMA, END = 0.0046, -0.09, 0.60, -0.59, 0.12, 2e6
LEVELS = [(2.0, 2), (1.4, 2), (1.0, 3), (0.7, 3), (0.5, 3), (0.35, 3), (0.25, 3), (0.2, 2)]


def log10_life(strain):
    low, high = -2.0, 12.0  # of log10 of reversals
    for _ in range(200):
        y = 0.5 * (low + high)
        if ELASTIC * 10 ** (B * y) + PLASTIC * 10 ** (C * y) > strain:
            low = y
        else:
            high = y
    return low - math.log10(2)


random.seed(5)
with open("tests.csv", "w") as out:
    out.write("strain_amplitude [%],cycles,status\n")
    for percent, count in LEVELS:
        for _ in range(count):
            life = 10 ** (log10_life(percent / 100) + SIGMA * random.gauss(0, 1))
            out.write(f"{percent},{min(life, END):.4g},{'failure' if life < END else 'runout'}\n")
