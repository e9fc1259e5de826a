"""The tests of this folder: python3 simulate.py > tests.csv. Standard library only.

Truth: log10 of the fatigue limit at 1e7 cycles is normal about log10(300 MPa) with a standard deviation of 0.02 (5 %). An
up-and-down sequence of 20 specimens in steps of 15 MPa from 315 MPa.
"""
import math
import random

random.seed(4)
print("amplitude [MPa],status")
stress = 315
for _ in range(20):
    failed = stress > 10 ** (math.log10(300) + 0.02 * random.gauss(0, 1))
    print(f"{stress},{'failure' if failed else 'runout'}")
    stress += -15 if failed else 15
