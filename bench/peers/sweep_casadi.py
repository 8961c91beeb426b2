"""The designs of `hardpoint sweep models/studies/strut_sweep.toml` once more, by CasADi: the program that an expert would write by hand for
this strut. Four relative coordinates are left after the ball joint and the tie rod are cut; residual, Jacobian, velocities and outputs are
generated straight-line C, Newton's loop and the metrics are C around it, one thread, `gcc -O3 -march=native`.

    hardpoint sweep models/studies/strut_sweep.toml --samples 100000 --threads 1 -o DIR
    python sweep_casadi.py DIR/designs.csv

It reads the designs from that table, solves both cases of each (81 and 61 output times), and holds its metrics against those of the table. What it
computes at every output time: position and velocity of the mechanism, toe, camber, height of the wheel centre, half track, and
the rates of the first three. Metrics come from the output times by cubic (value, slope) or no interpolation (ranges). Hardpoint computes besides:
acceleration, all eight measures with rate and acceleration, and metrics from polynomials of degree 5 between the output times, so that the two
differ by what the output times leave open.
"""
import csv
import ctypes
import os
import subprocess
import sys
import tempfile
import time

import casadi as ca
import numpy as np

# mm; changed by the design: names of the columns
POINTS = dict(A=(270.51, 345.44, -59.69), B=(-43.18, 373.38, -125.73), E=(27.94, 662.94, -104.14), S=(-5.08, 619.76, -1.27),
              T=(-83.82, 541.02, 468.63), D=(-200, 574.803759, -1.27), C=(-200, 200, -50))
NAMES = "ABESTDC"
COLUMNS = {"lca_front_z": ("A", 2), "lca_rear_z": ("B", 2), "strut_top_y": ("T", 1), "tie_rod_outer_y": ("D", 1), "tie_rod_outer_z": ("D", 2),
           "tie_rod_inner_z": ("C", 2)}
METRICS = ["bump.toe_in_bump", "bump.bump_steer", "bump.toe_range", "steer.ackermann", "bump.camber_gain", "bump.track_change"]
SPIN, CENTRE, CONTACT = (0.0035, 1, 0.0175), (0, 750.062, 0), (0, 755.4, -310)


def functions():
    p, x, v, d = ca.SX.sym("p", 21), ca.SX.sym("x", 4), ca.SX.sym("v", 4), ca.SX.sym("d", 4)    # d = f, g and their rates
    P = {k: p[3*i:3*i+3] for i, k in enumerate(NAMES)}
    f, g = d[0], d[1]
    unit = lambda y: y/ca.norm_2(y)
    e, au = unit(P["A"]-P["B"]), unit(P["T"]-P["S"])
    c, s = ca.cos(x[0]), ca.sin(x[0])
    arm = c*ca.SX.eye(3) + (1-c)*ca.mtimes(e, e.T) + s*ca.skew(e)
    (c1, s1), (c2, s2), (c3, s3) = [(ca.cos(x[i]), ca.sin(x[i])) for i in (1, 2, 3)]
    Rx = ca.vertcat(ca.horzcat(1, 0, 0), ca.horzcat(0, c1, -s1), ca.horzcat(0, s1, c1))
    Ry = ca.vertcat(ca.horzcat(c2, 0, s2), ca.horzcat(0, 1, 0), ca.horzcat(-s2, 0, c2))
    Rz = ca.vertcat(ca.horzcat(c3, -s3, 0), ca.horzcat(s3, c3, 0), ca.horzcat(0, 0, 1))
    R = ca.mtimes(ca.mtimes(Rx, Ry), Rz)
    knuckle = lambda Q: P["T"] + ca.mtimes(R, Q - P["T"] - au*f)
    rod, rod0 = knuckle(P["D"]) - P["C"] - ca.vertcat(0, g, 0), P["D"] - P["C"]
    Phi = ca.vertcat(P["A"] + ca.mtimes(arm, P["E"]-P["A"]) - knuckle(P["E"]), (ca.dot(rod, rod) - ca.dot(rod0, rod0))/2)
    J = ca.jacobian(Phi, x)
    y, yd = ca.vertcat(x, f, g), ca.vertcat(v, d[2], d[3])
    rate = lambda ex: ca.jtimes(ex, y, yd)
    v_of = -ca.solve(J, ca.substitute(rate(Phi), v, ca.DM.zeros(4)))
    spin = ca.mtimes(R, unit(ca.DM(SPIN)))
    toe, camber = ca.atan2(spin[0], spin[1]), -ca.asin(spin[2])
    height, half = knuckle(ca.DM(CENTRE))[2], knuckle(ca.DM(CONTACT))[1]
    out = ca.vertcat(toe, camber, height, half, rate(toe), rate(camber), rate(height))
    return [ca.Function("fPJ", [x, d, p], ca.cse([Phi, ca.densify(ca.solve(J, Phi))])),
            ca.Function("fV", [x, d, p], ca.cse([ca.densify(v_of)])),
            ca.Function("fO", [x, v, d, p], ca.cse([ca.densify(out)]))]


DRIVER = r"""
#include <math.h>
#include "sweep_g.h"
static double W[%(nw)d]; static long long IW[16];
enum { TOE, CAMBER, Z, HALF, DTOE, DCAMBER, DZ, N };
/* one motion: f = f1 sin 2 pi t, g = g1 sin 2 pi t over t in 0..1; N numbers per output time; 0 where it does not close */
static int motion(int steps, double f1, double g1, const double *p, double O[][N]) {
  double x[4] = {0}, v[4] = {0}, F[4], dx[4];
  for (int k = 0; k <= steps; k++) {
    const double w = 2*M_PI; double t = (double)k/steps, h = k > 0 ? 1.0/steps : 0, s = sin(w*t), c = w*cos(w*t);
    double d[4] = {f1*s, g1*s, f1*c, g1*c};
    for (int i = 0; i < 4; i++) x[i] += h*v[i];
    const double *a[3] = {x, d, p}; double *r[2] = {F, dx}; double e; int it = 0;
    for (;;) { fPJ(a, r, IW, W, 0); e = 0; for (int i = 0; i < 4; i++) e = fmax(e, fabs(F[i])); if (!(e < 1e30) || it > 20) return 0; if (e < 1e-8) break;
      for (int i = 0; i < 4; i++) x[i] -= dx[i]; it++; }
    double *rv[1] = {v}; fV(a, rv, IW, W, 0);
    const double *b[4] = {x, v, d, p}; double *ro[1] = {O[k]}; fO(b, ro, IW, W, 0);
  }
  return 1;
}
/* toe or camber, and its rate, where the wheel's travel is `at`: cubic in time */
static void where(int steps, double O[][N], double z0, double at, int of, double *value, double *slope) {
  *value = *slope = NAN;
  double h = 1.0/steps;
  for (int k = 0; k < steps; k++) {
    double a = O[k][Z] - z0 - at, b = O[k+1][Z] - z0 - at;
    if (a*b > 0) continue;
    double s = a/(a - b);
    for (int i = 0; i < 6; i++) {              /* Newton on the cubic of the travel */
      double da = h*O[k][DZ], db = h*O[k+1][DZ], c2 = 3*(b-a) - 2*da - db, c3 = da + db - 2*(b-a);
      s -= (a + s*(da + s*(c2 + s*c3)))/(da + s*(2*c2 + 3*s*c3));
    }
    double y = O[k][of], y1 = O[k+1][of], da = h*O[k][of+DTOE], db = h*O[k+1][of+DTOE], c2 = 3*(y1-y) - 2*da - db, c3 = da + db - 2*(y1-y);
    double za = h*O[k][DZ], zb = h*O[k+1][DZ], z2 = 3*(b-a) - 2*za - zb, z3 = za + zb - 2*(b-a);
    *value = y + s*(da + s*(c2 + s*c3));
    *slope = (da + s*(2*c2 + 3*s*c3))/(za + s*(2*z2 + 3*s*z3));
    return;
  }
}
long sweep(long n, const double *P, double *M) {
  static double B[81][N], S[61][N]; long failed = 0;
  for (long k = 0; k < n; k++) {
    double *m = M + 6*k; const double *p = P + 21*k; double unused;
    if (!motion(80, -40, 0, p, B) || !motion(60, 0, 30, p, S)) { failed++; for (int i = 0; i < 6; i++) m[i] = NAN; continue; }
    where(80, B, 0, 30, TOE, m, &unused);
    where(80, B, 0, 0, TOE, &unused, m + 1);
    where(80, B, 0, 0, CAMBER, &unused, m + 4);
    double lo = B[0][TOE], hi = lo, l = B[0][HALF], r = l, sum = 0;
    for (int i = 1; i < 81; i++) { lo = fmin(lo, B[i][TOE]); hi = fmax(hi, B[i][TOE]); l = fmin(l, B[i][HALF]); r = fmax(r, B[i][HALF]); }
    double way = 0;                            /* the mean of toe over the way of the rack, to and fro */
    for (int i = 0; i < 60; i++) { double by = fabs(sin(2*M_PI*(i+1)/60) - sin(2*M_PI*i/60)); way += by; sum += 0.5*by*(S[i][TOE] + S[i+1][TOE]); }
    sum /= way;
    m[2] = hi - lo; m[3] = sum; m[5] = r - l;
  }
  return failed;
}
"""


def library():
    folder = tempfile.mkdtemp()
    generated = ca.CodeGenerator("sweep_g.c", dict(with_header=True))
    made = functions()
    for f in made:
        generated.add(f)
    generated.generate(folder + os.sep)
    with open(os.path.join(folder, "sweep_d.c"), "w") as file:
        file.write(DRIVER % dict(nw=max(f.sz_w() for f in made)+16))
    subprocess.check_call(["gcc", "-O3", "-march=native", "-shared", "-fPIC", "-fno-math-errno", "-w", "sweep_g.c", "sweep_d.c", "-o",
                           "sweep.so", "-lm"], cwd=folder)
    return ctypes.CDLL(os.path.join(folder, "sweep.so"))


def main():
    with open(sys.argv[1]) as file:
        rows = csv.reader(file)
        head = [name.split(" [")[0] for name in next(rows)]
        table = np.array([[float(x) if x else np.nan for x in row[:-1]] for row in rows])
    P = np.tile(np.array([POINTS[k] for k in NAMES], float).ravel(), (len(table), 1))
    for column, (point, axis) in COLUMNS.items():
        P[:, 3*NAMES.index(point) + axis] += table[:, head.index(column)]
    P, M = np.ascontiguousarray(P), np.empty((len(table), 6))
    lib = library()
    lib.sweep.restype = ctypes.c_long
    pointer = lambda a: a.ctypes.data_as(ctypes.c_void_p)
    cpu, wall = time.process_time(), time.perf_counter()
    failed = lib.sweep(ctypes.c_long(len(P)), pointer(P), pointer(M))
    cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
    print(f"casadi: {len(P)} designs in {cpu:.2f} s of CPU time ({wall:.2f} s), {len(P)/cpu:.0f} designs/s, {len(P)*142/cpu/1e6:.2f} M positions/s; "
          f"{failed} failed")
    M[:, [0, 1, 2, 3, 4]] = np.degrees(M[:, [0, 1, 2, 3, 4]])
    for k, name in enumerate(METRICS):
        theirs = table[:, head.index(name)]
        print(f"  {name}: largest difference {np.nanmax(np.abs(M[:, k] - theirs)):.1e} of {np.nanmax(np.abs(theirs)):.3g}")


if __name__ == "__main__":
    main()
