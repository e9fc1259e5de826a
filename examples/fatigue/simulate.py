"""The tests of this folder: python3 simulate.py > tests.csv. Standard library only.

Truth: S_f = S_a/(1 - S_m/S_ut) = a N^b with a = 2000 MPa, b = -0.12, S_ut = 1200 MPa; log10 N scatters with a standard
deviation of 0.15. Tests are stopped after 2e6 cycles.
"""
import math
import random

A, B, S_UT, SIGMA, END = 2000.0, -0.12, 1200.0, 0.15, 2e6
LEVELS = [(600, -1, 3), (500, -1, 3), (430, -1, 4), (380, -1, 4), (350, 0.1, 3), (300, 0.1, 4), (260, 0.1, 4)]

random.seed(20)
print("stress_amplitude_MPa,stress_ratio,cycles,status")
for amplitude, ratio, count in LEVELS:
    mean = amplitude * (1 + ratio) / (1 - ratio)
    reversed_amplitude = amplitude / (1 - mean / S_UT)
    for _ in range(count):
        life = 10 ** (math.log10(reversed_amplitude / A) / B + SIGMA * random.gauss(0, 1))
        status = "failure" if life < END else "runout"
        print(f"{amplitude},{ratio},{min(life, END):.4g},{status}")
