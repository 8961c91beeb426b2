"""CasADi, general: constraint equations in absolute coordinates (cartesian_sx.py), whose residual, Jacobian and right-hand
sides CasADi generates as C. The loop round them is written here in C: Newton with a predictor, one dense LU per step used
again for velocity, acceleration and all right-hand sides of the sensitivities."""
import ctypes
import os
import subprocess

import casadi as ca
import cartesian_sx as cs
import numpy as np
import workloads as W

GCC = ["gcc", "-O3", "-march=native", "-shared", "-fPIC", "-fno-math-errno"]
TMP = W.tmpdir()


def sens_function(m):
    """direct differentiation at a solved state: dq, dv, da / dp"""
    q, v, a, p, t = m.q, m.qd, m.qdd, m.p, m.t
    npar = p.numel()
    R1 = m.Phi
    R2 = ca.mtimes(m.J, v) - m.nu
    R3 = ca.mtimes(m.J, a) - m.gam
    Q, V = ca.SX.sym("Q", m.n, npar), ca.SX.sym("V", m.n, npar)
    B1 = -ca.densify(ca.jacobian(R1, p))
    B2 = -ca.densify(ca.jacobian(R2, p) + ca.mtimes(ca.jacobian(R2, q), Q))
    B3 = -ca.densify(ca.jacobian(R3, p) + ca.mtimes(ca.jacobian(R3, q), Q) + ca.mtimes(ca.jacobian(R3, v), V))
    return B1, B2, B3, Q, V


def to_layout(m, X):
    f = ca.Function("o", [m.q, m.qd, m.qdd], [m.out])
    n = m.n
    return np.stack([np.array(f(x[:n], x[n:2*n], x[2*n:])).T for x in X])


def layout_sens(m, X, S):
    """S: (steps, 3n, np) -> (steps, nb, 24, np)"""
    n = m.n
    x = ca.vertcat(m.q, m.qd, m.qdd)
    f = ca.Function("oj", [m.q, m.qd, m.qdd], [ca.jacobian(ca.vec(m.out), x)])
    out = np.empty((len(X), m.nb, 24, S.shape[2]))
    for k in range(len(X)):
        out[k] = (np.array(f(X[k][:n], X[k][n:2*n], X[k][2*n:])) @ S[k]).reshape(m.nb, 24, -1)
    return out


def compile_c(functions, name, driver):
    """generated functions and the C loop round them as a shared library"""
    generated = ca.CodeGenerator(name + "_g.c", dict(with_header=True))
    for f in functions:
        generated.add(f)
    generated.generate(TMP + os.sep)
    with open(os.path.join(TMP, name + "_d.c"), "w") as file:
        file.write(driver)
    subprocess.check_call(GCC + [name + "_g.c", name + "_d.c", "-o", name + ".so", "-lm"], cwd=TMP)


# ---------------------------------------------------------------- C driver ("-lu")
DRIVER = r"""
#include <math.h>
#include <string.h>
#include <stdlib.h>
#include "%(name)s_g.h"
#define N %(n)d
#define NP %(np)d
typedef long long int ci;
static double J[N*N], B[N], W[%(nw)d]; static ci IW[%(niw)d]; static int piv[N];
static double S1[N*NP], S2[N*NP], S3[N*NP], T[N*NP];
/* J column major from CasADi -> row major LU with partial pivoting */
static void lu(double*A){ for(int k=0;k<N;k++){ int m=k; double b=fabs(A[k*N+k]); for(int i=k+1;i<N;i++){ double x=fabs(A[i*N+k]); if(x>b){b=x;m=i;} }
  piv[k]=m; if(m!=k) for(int j=0;j<N;j++){ double t=A[k*N+j];A[k*N+j]=A[m*N+j];A[m*N+j]=t; }
  double ip=1.0/A[k*N+k]; for(int i=k+1;i<N;i++){ double l=A[i*N+k]; if(l==0) continue; l*=ip; A[i*N+k]=l; double*a=A+i*N,*c=A+k*N; for(int j=k+1;j<N;j++) a[j]-=l*c[j]; } } }
static void ls(const double*A,double*x){ for(int k=0;k<N;k++){ double t=x[k]; x[k]=x[piv[k]]; x[piv[k]]=t; }
  for(int i=0;i<N;i++){ double s=x[i]; for(int j=0;j<i;j++) s-=A[i*N+j]*x[j]; x[i]=s; }
  for(int i=N-1;i>=0;i--){ double s=x[i]; for(int j=i+1;j<N;j++) s-=A[i*N+j]*x[j]; x[i]=s/A[i*N+i]; } }
/* B: N x NP column major -> row major T, solve all right-hand sides together, back */
static void lsm(const double*A,double*Bc){ for(int i=0;i<N;i++) for(int j=0;j<NP;j++) T[i*NP+j]=Bc[j*N+i];
  for(int k=0;k<N;k++) if(piv[k]!=k) for(int j=0;j<NP;j++){ double t=T[k*NP+j];T[k*NP+j]=T[piv[k]*NP+j];T[piv[k]*NP+j]=t; }
  for(int i=0;i<N;i++) for(int k=0;k<i;k++){ double l=A[i*N+k]; if(l==0) continue; for(int j=0;j<NP;j++) T[i*NP+j]-=l*T[k*NP+j]; }
  for(int i=N-1;i>=0;i--){ for(int k=i+1;k<N;k++){ double l=A[i*N+k]; if(l==0) continue; for(int j=0;j<NP;j++) T[i*NP+j]-=l*T[k*NP+j]; }
    double d=1.0/A[i*N+i]; for(int j=0;j<NP;j++) T[i*NP+j]*=d; }
  for(int i=0;i<N;i++) for(int j=0;j<NP;j++) Bc[j*N+i]=T[i*NP+j]; }
static double L[N*N];
static void jac(const double*q,const double*p,const double*t){ const double*a[3]={q,p,t}; double*r[1]={J}; fJ(a,r,IW,W,0);
  for(int i=0;i<N;i++) for(int j=0;j<N;j++) L[i*N+j]=J[j*N+i]; lu(L); }
/* returns total Newton iterations; X: (steps,3N), S: (steps,3N,NP col-major blocks) or NULL */
long run(int steps,double dt,const double*q0,const double*p,double tol,double*X,double*S,double*resmax){
  double q[N],v[N],a[N],f[N]; memcpy(q,q0,sizeof q); memset(v,0,sizeof v); memset(a,0,sizeof a); long its=0; *resmax=0;
  for(int k=0;k<steps;k++){ double t=k*dt,h=k?dt:0; for(int i=0;i<N;i++) q[i]+=h*(v[i]+0.5*h*a[i]);
    const double*A3[3]={q,p,&t}; double*R1[1]={f}; int it=0; double e;
    for(;;){ fPhi(A3,R1,IW,W,0); e=0; for(int i=0;i<N;i++) e=fmax(e,fabs(f[i])); if((e<tol&&it>0)||it>20) break;
      if(e<tol) break; jac(q,p,&t); ls(L,f); for(int i=0;i<N;i++) q[i]-=f[i]; it++; }
    its+=it; *resmax=fmax(*resmax,e);
    jac(q,p,&t); double*Rn[1]={v}; fNu(A3,Rn,IW,W,0); ls(L,v);
    const double*A4[4]={q,v,p,&t}; double*Rg[1]={a}; fGam(A4,Rg,IW,W,0); ls(L,a);
    double*x=X+(size_t)k*3*N; memcpy(x,q,sizeof q); memcpy(x+N,v,sizeof v); memcpy(x+2*N,a,sizeof a);
    if(S){ double*s=S+(size_t)k*3*N*NP; double*Q=s,*V=s+N*NP,*C=s+2*N*NP;
      double*r1[1]={Q}; fB1(A3,r1,IW,W,0); lsm(L,Q);
      const double*b2[5]={q,v,p,&t,Q}; double*r2[1]={V}; fB2(b2,r2,IW,W,0); lsm(L,V);
      const double*b3[7]={q,v,a,p,&t,Q,V}; double*r3[1]={C}; fB3(b3,r3,IW,W,0); lsm(L,C); } }
  return its; }
"""


class CLu:
    def __init__(self, m, name):
        self.m = m
        library = os.path.join(TMP, name + ".so")
        if W.stale(library, __file__, cs.__file__):
            self.compile(name)
        self.lib = ctypes.CDLL(library)
        self.lib.run.restype = ctypes.c_long

    def compile(self, name):
        m = self.m
        n, npar = m.n, m.p.numel()
        B1, B2, B3, Q, V = sens_function(m)
        q, v, a, p, t = m.q, m.qd, m.qdd, m.p, m.t
        fs = [ca.Function("fPhi", [q, p, t], [ca.densify(m.Phi)]), ca.Function("fJ", [q, p, t], [ca.densify(m.J)]),
              ca.Function("fNu", [q, p, t], [m.nu]), ca.Function("fGam", [q, v, p, t], [m.gam]),
              ca.Function("fB1", [q, p, t], [B1]), ca.Function("fB2", [q, v, p, t, Q], [B2]),
              ca.Function("fB3", [q, v, a, p, t, Q, V], [B3])]
        fs = [ca.Function(f.name(), f.sx_in(), ca.cse([f(*f.sx_in())])) for f in fs]
        nw = max(f.sz_w() for f in fs) + 16
        niw = max(f.sz_iw() for f in fs) + 16
        compile_c(fs, name, DRIVER % dict(name=name, n=n, np=npar, nw=nw, niw=niw))

    def run(self, steps, dt, p, sens, X=None, S=None):
        m = self.m
        if X is None:
            X = np.empty((steps, 3*m.n))
        if sens and S is None:
            S = np.empty((steps, 3, m.p.numel(), m.n))
        res = ctypes.c_double()
        P = lambda x: x.ctypes.data_as(ctypes.c_void_p)
        p = np.ascontiguousarray(p)
        its = self.lib.run(ctypes.c_int(steps), ctypes.c_double(dt), P(m.q0), P(p), ctypes.c_double(1e-10),
                           P(X), P(S) if sens else None, ctypes.byref(res))
        self.its = its/steps
        self.res = res.value
        return X, S


def single(model, workloads, p, steps, T):
    """one design: motion only, and with all sensitivities"""
    dt = T/(steps-1)
    for name in W.asked(workloads):
        sensitivities, base = name.endswith("s"), name.rstrip("s")
        c = CLu(model, "caslu_" + base)
        X, S = np.empty((steps, 3*model.n)), np.empty((steps, 3, model.p.numel(), model.n))
        time, _ = W.median_time(lambda: c.run(steps, dt, p, sensitivities, X, S), 15)
        if sensitivities:
            Sr = S.transpose(0, 1, 3, 2).reshape(steps, 3*model.n, -1)
            errors = W.sens_errors(layout_sens(model, X, Sr), W.reference(base + "S"))
        else:
            errors = W.errors(to_layout(model, X), W.reference(base))
        W.emit("casadi-c-lu", name, us_per_step=time/steps*1e6, newton_iters_mean=c.its, **errors)


def designs(workloads):
    model = cs.w2()
    D, steps = W.w4_designs(), W.W4_STEPS
    dt = W.W4_T/(steps-1)
    X, S = np.empty((steps, 3*model.n)), np.empty((steps, 3, 24, model.n))
    for name in W.asked(workloads):
        c = CLu(model, "caslu_W2")
        sensitivities = name == "W4s"
        some = D[:300] if sensitivities else D

        def sweep():
            for p in some:
                c.run(steps, dt, p, sensitivities, X, S)
        time, _ = W.median_time(sweep, 5)
        if sensitivities:
            c.run(steps, dt, D[0], True, X, S)
            Sr = S.transpose(0, 1, 3, 2).reshape(steps, 3*model.n, -1)
            errors = W.sens_errors(layout_sens(model, X, Sr), W.reference("W4S")[0])
        else:
            errors = W.errors(to_layout(model, X), W.reference("W4")[-1])
        W.emit("casadi-c-lu", name, us_per_step=time/len(some)/steps*1e6, designs_steps_per_s=len(some)*steps/time, **errors)


single(cs.w1(), ["W1", "W1s"], W.W1_P, W.W1_STEPS, W.W1_T)
single(cs.w2(), ["W2", "W2s"], W.W2_P, W.W2_STEPS, W.W2_T)
designs(["W4", "W4s"])
