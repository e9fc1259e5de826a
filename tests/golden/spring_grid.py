#!/usr/bin/env python3
"""Moments of a posterior that a bound cuts, for tests/infer/exact_error_test.cpp: the nine springs of
examples/spring by Smith, Watson and Topper, all priors uniform, the scatter of log10 life normal.

Given b and sigma, log10_a is normal and cut to its bounds: its part is a formula. The other two are a product of
Gauss-Legendre rules of 300 nodes, in b and in log sigma (with 200 nodes the same to 12 digits). Run from the project's root:
    python3 tests/golden/spring_grid.py
"""
import csv
import math

NODES = 300
def gl(n):
    x=[];w=[]
    for i in range(n):
        t=math.cos(math.pi*(i+.75)/(n+.5))
        for _ in range(100):
            p0,p1=1.,t
            for k in range(2,n+1): p0,p1=p1,((2*k-1)*t*p1-(k-1)*p0)/k
            dp=n*(t*p1-p0)/(t*t-1); d=p1/dp; t-=d
            if abs(d)<1e-15: break
        x.append(t); w.append(2/((1-t*t)*dp*dp))
    return x,w
rows=list(csv.DictReader(open('examples/spring/spring_life.csv')))
s=[];y=[]
for r in rows:
    m=float(r['mean_stress_MPa']);a=float(r['alternating_stress_MPa'])
    s.append(.5*math.log10((m+a)*a*1e12)); y.append(math.log10(float(r['life_normalized'])*1e5))
n=len(y); ms=sum(s)/n; my=sum(y)/n
sss=sum((v-ms)**2 for v in s); syy=sum((v-my)**2 for v in y); ssy=sum((u-ms)*(v-my) for u,v in zip(s,y))
x,w=gl(NODES)
phi=lambda z: math.exp(-z*z/2)/math.sqrt(2*math.pi)
Phi=lambda z: .5*math.erfc(-z/math.sqrt(2))
acc=[]
for i in range(NODES):
    b=-.08+.02*x[i]; mu=ms-b*my; q=sss-2*b*ssy+b*b*syy
    for j in range(NODES):
        ls=math.log(.01)+(x[j]+1)/2*math.log(60); sg=math.exp(ls)
        sd=sg*abs(b)/math.sqrt(n); al=(8-mu)/sd; be=(10-mu)/sd
        Z=Phi(be)-Phi(al)
        if Z<=0: continue
        W=math.exp(-n*ls-q/(2*(sg*b)**2)-10)*sd*Z*w[i]*w[j]*sg
        d=(phi(al)-phi(be))/Z; Ea=mu+sd*d; Va=sd*sd*(1+(al*phi(al)-be*phi(be))/Z-d*d)
        acc.append((W,Ea-9,Va,b,sg))
t=sum(a[0] for a in acc)
ma=sum(a[0]*a[1] for a in acc)/t; print('a',ma+9-6,math.sqrt(sum(a[0]*(a[2]+(a[1]-ma)**2) for a in acc)/t))
for k in (3,4):
    m=sum(a[0]*a[k] for a in acc)/t; print(k,m,math.sqrt(sum(a[0]*(a[k]-m)**2 for a in acc)/t))
