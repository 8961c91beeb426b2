"""CasADi, the strongest form that an expert could write for W2: the four relative coordinates left after cutting the ball
joint and the tie rod (the paper's choice); residual, Jacobian, velocity, acceleration, all outputs and all total derivatives
each as one generated straight-line C function, Newton's loop in C. Made for this mechanism by hand, unlike
peer_casadi_lu.py, which is general."""
import ctypes
import os
import subprocess

import casadi as ca
import numpy as np
import workloads as W

TMP = W.tmpdir()


def build():
    p, x, v, a = ca.SX.sym("p", 24), ca.SX.sym("x", 4), ca.SX.sym("v", 4), ca.SX.sym("a", 4)
    d = ca.SX.sym("d", 6)                       # f fd fdd g gd gdd
    f, g = d[0], d[3]
    P = {k: p[3*i:3*i+3] for i, k in enumerate(W.W2_NAMES)}
    unit = lambda y: y/ca.norm_2(y)
    e, au, u = unit(P["B"]-P["A"]), unit(P["T"]-P["S"]), unit(P["K"]-P["C"])
    c, s = ca.cos(x[0]), ca.sin(x[0])
    Rl = c*ca.SX.eye(3) + (1-c)*ca.mtimes(e, e.T) + s*ca.skew(e)
    ang = lambda i: (ca.cos(x[i]), ca.sin(x[i]))
    (ca_, sa), (cb, sb), (cg, sg) = ang(1), ang(2), ang(3)
    Rx = ca.vertcat(ca.horzcat(1, 0, 0), ca.horzcat(0, ca_, -sa), ca.horzcat(0, sa, ca_))
    Ry = ca.vertcat(ca.horzcat(cb, 0, sb), ca.horzcat(0, 1, 0), ca.horzcat(-sb, 0, cb))
    Rz = ca.vertcat(ca.horzcat(cg, -sg, 0), ca.horzcat(sg, cg, 0), ca.horzcat(0, 0, 1))
    Rxy = ca.mtimes(Rx, Ry); R = ca.mtimes(Rxy, Rz)
    kpt = lambda Q: P["T"] + ca.mtimes(R, Q - P["T"] - au*f)
    dC = kpt(P["D"]) - P["C"] - u*g; dc0 = P["D"]-P["C"]
    Phi = ca.vertcat(P["A"] + ca.mtimes(Rl, P["E"]-P["A"]) - kpt(P["E"]), (ca.dot(dC, dC)-ca.dot(dc0, dc0))/2)
    J = ca.jacobian(Phi, x)
    y = ca.vertcat(x, f, g); yd = ca.vertcat(v, d[1], d[4]); ydd = ca.vertcat(a, d[2], d[5])
    D1 = lambda ex: ca.jtimes(ex, y, yd)                                   # d/dt
    D2 = lambda ex: ca.jtimes(D1(ex), y, yd) + ca.jtimes(ex, y, ydd)       # d2/dt2
    z4 = ca.DM.zeros(4)
    rv = ca.substitute(D1(Phi), v, z4)
    vex = -ca.solve(J, rv)
    ra = ca.substitute(ca.jtimes(D1(Phi), y, yd) + ca.jtimes(Phi, y, ydd), a, z4)
    aex = -ca.solve(J, ra)                                                  # uses v
    w = ca.vertcat(v[1], 0, 0) + Rx[:, 1]*v[2] + Rxy[:, 2]*v[3]
    al = ca.jtimes(w, y, yd) + ca.jtimes(w, v, a)
    F = [ca.DM(q) for q in W.W2_FRAME]
    pos = [P["A"] + ca.mtimes(Rl, F[0]-P["A"]), kpt(F[1]), P["T"] + ca.mtimes(R, F[2]-P["T"]), F[3] + u*g]
    rots = [Rl, R, R, ca.SX.eye(3)]
    ws = [e*v[0], w, w, ca.SX.zeros(3)]; als = [e*a[0], al, al, ca.SX.zeros(3)]
    O = ca.vertcat(*[ca.vertcat(pos[b], ca.reshape(rots[b].T, 9, 1), D1(pos[b]), ws[b], D2(pos[b]), als[b]) for b in range(4)])
    O = ca.densify(O)
    fPJ = ca.Function("fPJ", [x, d, p], ca.cse([Phi, ca.densify(ca.solve(J, Phi))]))
    fK = ca.Function("fK", [x, d, p], ca.cse([vex, ca.substitute(aex, v, vex)]))
    fO = ca.Function("fO", [x, v, a, d, p], ca.cse([O]))
    # total derivative of the outputs: chain through x, v, a with one J each level
    X, V, A = (ca.SX.sym(n, 4, 24) for n in "XVA")
    dx = -ca.solve(J, ca.jacobian(Phi, p))
    Rv = ca.mtimes(J, v) + rv; Ra = ca.mtimes(J, a) + ra
    dv = -ca.solve(J, ca.jacobian(Rv, p) + ca.mtimes(ca.jacobian(Rv, x), X))
    da = -ca.solve(J, ca.jacobian(Ra, p) + ca.mtimes(ca.jacobian(Ra, x), X) + ca.mtimes(ca.jacobian(Ra, v), V))
    dO = ca.jacobian(O, p) + ca.mtimes(ca.jacobian(O, x), X) + ca.mtimes(ca.jacobian(O, v), V) + ca.mtimes(ca.jacobian(O, a), A)
    f1 = ca.Function("f1", [x, v, a, d, p], ca.cse([ca.densify(dx)]))
    f2 = ca.Function("f2", [x, v, a, d, p, X], ca.cse([ca.densify(dv)]))
    f3 = ca.Function("f3", [x, v, a, d, p, X, V], ca.cse([ca.densify(da)]))
    f4 = ca.Function("f4", [x, v, a, d, p, X, V, A], ca.cse([ca.densify(dO)]))
    return [fPJ, fK, fO, f1, f2, f3, f4]


DRV = r"""
#include <math.h>
#include <string.h>
#include "casmin_g.h"
static double W[%(nw)d]; static long long IW[16];
static void drv(double t,const double*c,double*d){ double s,k; sincos(c[1]*t,&s,&k); d[0]=c[0]*s; d[1]=c[0]*c[1]*k; d[2]=-c[1]*c[1]*d[0];
  sincos(c[3]*t,&s,&k); d[3]=c[2]*s; d[4]=c[2]*c[3]*k; d[5]=-c[3]*c[3]*d[3]; }
long run(int steps,double dt,const double*c,const double*p,double tol,double*O,int so,double*S,int ss,double*resmax){
  double x[4]={0},v[4]={0},a[4]={0},d[6],F[4],dx[4],X[96],V[96],A[96]; long its=0; *resmax=0;
  for(int k=0;k<steps;k++){ double h=k?dt:0; drv(k*dt,c,d); for(int i=0;i<4;i++) x[i]+=h*(v[i]+0.5*h*a[i]);
    const double*a3[3]={x,d,p}; double*r2[2]={F,dx}; double e; int it=0;
    for(;;){ fPJ(a3,r2,IW,W,0); e=0; for(int i=0;i<4;i++) e=fmax(e,fabs(F[i])); if(e<tol||it>20) break; for(int i=0;i<4;i++) x[i]-=dx[i]; it++; }
    its+=it; *resmax=fmax(*resmax,e); double*rk[2]={v,a}; fK(a3,rk,IW,W,0);
    const double*a5[8]={x,v,a,d,p,X,V,A}; double*ro[1]={O+(size_t)k*so}; fO(a5,ro,IW,W,0);
    if(S){ double*q[1]={X}; f1(a5,q,IW,W,0); q[0]=V; f2(a5,q,IW,W,0); q[0]=A; f3(a5,q,IW,W,0); q[0]=S+(size_t)k*ss; f4(a5,q,IW,W,0); } }
  return its; }
"""


def compile_c():
    functions = build()
    generated = ca.CodeGenerator("casmin_g.c", dict(with_header=True))
    for f in functions:
        generated.add(f)
    generated.generate(TMP + os.sep)
    with open(os.path.join(TMP, "casmin_d.c"), "w") as file:
        file.write("#define _GNU_SOURCE\n" + DRV % dict(nw=max(f.sz_w() for f in functions)+16))
    subprocess.check_call(["gcc", "-O3", "-march=native", "-shared", "-fPIC", "-fno-math-errno", "-w",
                           "casmin_g.c", "casmin_d.c", "-o", "casmin.so", "-lm"], cwd=TMP)


def main():
    library = os.path.join(TMP, "casmin.so")
    if W.stale(library, __file__):
        compile_c()
    lib = ctypes.CDLL(library)
    lib.run.restype = ctypes.c_long
    laws = np.array([W.STRUT_AMP, 2*np.pi*W.STRUT_HZ, W.RACK_AMP, 2*np.pi*W.RACK_HZ])
    ptr = lambda y: y.ctypes.data_as(ctypes.c_void_p)
    residual = ctypes.c_double()

    def run(p, steps, T, O, S=None):
        return lib.run(ctypes.c_int(steps), ctypes.c_double(T/(steps-1)), ptr(laws), ptr(p), ctypes.c_double(1e-10), ptr(O), ctypes.c_int(96),
                       ptr(S) if S is not None else None, ctypes.c_int(96*24), ctypes.byref(residual))

    def sensitivities(S):
        return S.transpose(0, 2, 1).reshape(len(S), 4, 24, 24)

    n, D = W.W2_STEPS, W.w4_designs()
    O, S, p = np.empty((n, 4, 24)), np.empty((n, 24, 96)), np.ascontiguousarray(W.W2_P)
    m = W.W4_STEPS
    Om, Sm = np.empty((m, 4, 24)), np.empty((m, 24, 96))
    for name in W.asked(["W2", "W2s", "W4", "W4s"]):
        if name == "W2":
            time, _ = W.median_time(lambda: [run(p, n, W.W2_T, O) for _ in range(10)], 15)
            steps, errors = 10*n, W.errors(O, W.reference("W2"))
        elif name == "W2s":
            time, _ = W.median_time(lambda: run(p, n, W.W2_T, O, S), 31)
            steps, errors = n, W.sens_errors(sensitivities(S), W.reference("W2S"))
        elif name == "W4":
            time, _ = W.median_time(lambda: [run(d, m, W.W4_T, Om) for d in D], 5)
            steps, errors = len(D)*m, W.errors(Om, W.reference("W4")[-1])
        else:
            some = D[:200]
            time, _ = W.median_time(lambda: [run(d, m, W.W4_T, Om, Sm) for d in some], 5)
            steps = len(some)*m
            run(D[0], m, W.W4_T, Om, Sm)
            errors = W.sens_errors(sensitivities(Sm), W.reference("W4S")[0])
        rate = dict(designs_steps_per_s=steps/time) if name.startswith("W4") else {}
        W.emit("casadi-c-min", name, us_per_step=time/steps*1e6, **rate, **errors)


main()
