# The tables of the studies beside it: wear of parts that differ, simulated with a fixed seed. Run it here; what was simulated stands in each study.
import random, math
r = random.Random(20261125)
with open('running_in/wear.csv','w') as f:
    f.write('part,F_N,s_km,depth_um\n')
    for i in range(6):
        a = 8*math.exp(0.3*r.gauss(0,1)); k = 0.02*math.exp(0.25*r.gauss(0,1)); F = [20,30,40,30,20,40][i]
        for s in [0.2,0.5,1,2,4,8,16]:
            f.write(f'{i+1},{F},{s:g},{a*(1-math.exp(-s/1.2))+k*F*s+0.4*r.gauss(0,1):.2f}\n')
with open('threshold/wear.csv','w') as f:
    f.write('part,F_N,s_km,V_mm3\n')
    for i in range(8):
        k = 2e-6*math.exp(0.3*r.gauss(0,1))
        for j,s in enumerate([2,5,10]):
            F = [15,20,30,40,50,25,35,60][(i+3*j)%8]
            V = k*max(F-18,0)*s*1e3
            f.write(f'{i+1},{F},{s:g},{V+0.03*r.gauss(0,1):.3f}\n')
with open('wiener/wear.csv','w') as f:
    f.write('unit,t_h,y_um\n')
    for i in range(40):
        q = 0.02*math.exp(0.3*r.gauss(0,1)); t0=y=0
        for j in range(8):
            t = 125*(j+1); y += q*(t-t0)+0.05*math.sqrt(t-t0)*r.gauss(0,1); t0=t
            f.write(f'{i+1},{t},{y+0.3*r.gauss(0,1):.2f}\n')
