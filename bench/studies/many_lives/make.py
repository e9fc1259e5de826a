# The table of the study beside it: so many lives of a Weibull distribution of 1000 h and shape 2, three in ten stopped before at times of their own,
# simulated with a fixed seed. `make.py 1000000 > lives.csv`; a second number is another seed, and 0 as the third stops none.
import random, sys
count = int(sys.argv[1]) if len(sys.argv) > 1 else 100000
seed = int(sys.argv[2]) if len(sys.argv) > 2 else 1
latest = 1000*0.886227/0.3          # the mean life over the share that is stopped
censored = len(sys.argv) < 4 or sys.argv[3] != '0'
r = random.Random(seed)
out = ['hours,status']
for _ in range(count):
    life, stop = r.weibullvariate(1000, 2), r.uniform(0, latest) if censored else float('inf')
    out.append(f'{min(life, stop):.6g},{"failure" if life <= stop else "runout"}')
print('\n'.join(out))
