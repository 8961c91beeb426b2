// Floor baselines: hand-derived closed-form kinematics of W1 (slider-crank) and
// W2 (MacPherson strut driven by strut length), position + velocity +
// acceleration of every body, templated on the scalar so that one source gives
//   double        one design, one time step
//   v8d           eight time steps or eight designs at once
//   Dual<M>       8*M forward-mode design derivatives at once
// Eight lanes are one register with AVX-512; elsewhere the compiler splits them.
#pragma once
#include <immintrin.h>
#include <cmath>

typedef double v8d __attribute__((vector_size(64)));
#ifdef __AVX512F__
static inline v8d vsqrt(v8d x) { return (v8d)_mm512_sqrt_pd((__m512d)x); }
static inline double maxabs(v8d x) { return _mm512_reduce_max_pd(_mm512_abs_pd((__m512d)x)); }
extern "C" v8d _ZGVeN8v_sin(v8d);
extern "C" v8d _ZGVeN8v_cos(v8d);
static inline v8d vsin(v8d x) { return _ZGVeN8v_sin(x); }
static inline v8d vcos(v8d x) { return _ZGVeN8v_cos(x); }
#else
static inline v8d vsqrt(v8d x) { v8d r; for (int i = 0; i < 8; i++) r[i] = __builtin_sqrt(x[i]); return r; }
static inline double maxabs(v8d x) { double m = 0; for (int i = 0; i < 8; i++) m = std::fmax(m, std::fabs(x[i])); return m; }
static inline v8d vsin(v8d x) { v8d r; for (int i = 0; i < 8; i++) r[i] = std::sin(x[i]); return r; }
static inline v8d vcos(v8d x) { v8d r; for (int i = 0; i < 8; i++) r[i] = std::cos(x[i]); return r; }
#endif
static inline double vsqrt(double x) { return __builtin_sqrt(x); }

template <int M> struct Dual {
    double v;
    v8d d[M];
    Dual() {}
    Dual(double x) : v(x) { for (int i = 0; i < M; i++) d[i] = v8d{}; }
};
#define DU template <int M> static inline __attribute__((always_inline)) Dual<M>
DU operator+(const Dual<M>& a, const Dual<M>& b) { Dual<M> r; r.v = a.v + b.v; for (int i = 0; i < M; i++) r.d[i] = a.d[i] + b.d[i]; return r; }
DU operator-(const Dual<M>& a, const Dual<M>& b) { Dual<M> r; r.v = a.v - b.v; for (int i = 0; i < M; i++) r.d[i] = a.d[i] - b.d[i]; return r; }
DU operator-(const Dual<M>& a) { Dual<M> r; r.v = -a.v; for (int i = 0; i < M; i++) r.d[i] = -a.d[i]; return r; }
DU operator*(const Dual<M>& a, const Dual<M>& b) { Dual<M> r; r.v = a.v * b.v; for (int i = 0; i < M; i++) r.d[i] = a.d[i] * b.v + b.d[i] * a.v; return r; }
DU operator/(const Dual<M>& a, const Dual<M>& b) { Dual<M> r; double ib = 1.0 / b.v; r.v = a.v * ib; for (int i = 0; i < M; i++) r.d[i] = (a.d[i] - b.d[i] * r.v) * ib; return r; }
DU operator+(const Dual<M>& a, double b) { Dual<M> r = a; r.v += b; return r; }
DU operator+(double b, const Dual<M>& a) { return a + b; }
DU operator-(const Dual<M>& a, double b) { Dual<M> r = a; r.v -= b; return r; }
DU operator-(double b, const Dual<M>& a) { Dual<M> r; r.v = b - a.v; for (int i = 0; i < M; i++) r.d[i] = -a.d[i]; return r; }
DU operator*(const Dual<M>& a, double b) { Dual<M> r; r.v = a.v * b; for (int i = 0; i < M; i++) r.d[i] = a.d[i] * b; return r; }
DU operator*(double b, const Dual<M>& a) { return a * b; }
DU operator/(double b, const Dual<M>& a) { Dual<M> r; double ia = 1.0 / a.v; r.v = b * ia; double k = -r.v * ia; for (int i = 0; i < M; i++) r.d[i] = a.d[i] * k; return r; }
DU vsqrt(const Dual<M>& a) { Dual<M> r; r.v = __builtin_sqrt(a.v); double k = 0.5 / r.v; for (int i = 0; i < M; i++) r.d[i] = a.d[i] * k; return r; }

static inline double val(double x) { return x; }
static inline double val(v8d x) { return x[0]; }
template <int M> static inline double val(const Dual<M>& x) { return x.v; }

template <class S> struct V3 { S x, y, z; };
#define AI static inline __attribute__((always_inline))
// result type of mixed arithmetic
template <class A, class B> using Mix = decltype(A() * B());
template <class A, class B> AI auto operator+(const V3<A>& a, const V3<B>& b) -> V3<decltype(a.x + b.x)> { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
template <class A, class B> AI auto operator-(const V3<A>& a, const V3<B>& b) -> V3<decltype(a.x - b.x)> { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
template <class A, class B> AI auto mul(const A& s, const V3<B>& b) -> V3<decltype(s * b.x)> { return {s * b.x, s * b.y, s * b.z}; }
template <class A, class B> AI auto dot(const V3<A>& a, const V3<B>& b) -> decltype(a.x * b.x) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class A, class B> AI auto cross(const V3<A>& a, const V3<B>& b) -> V3<decltype(a.x * b.x)> { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

// ------------------------------------------------------------------ W1
template <class G> struct SC { G J1x, J1y, J3y, dx, dy, l2, uxl, uyl, kx, ky, mx, my, nx; };
template <class G> AI SC<G> sc_setup(const G* p, const double* F) {
    SC<G> g;
    g.J1x = p[0]; g.J1y = p[1]; g.J3y = p[5];
    g.dx = p[2] - p[0]; g.dy = p[3] - p[1];
    G ex = p[4] - p[2], ey = p[5] - p[3];
    g.l2 = ex * ex + ey * ey;
    g.uxl = ex / g.l2; g.uyl = ey / g.l2;
    g.kx = F[0] - p[0]; g.ky = F[1] - p[1];
    g.mx = F[2] - p[2]; g.my = F[3] - p[3];
    g.nx = F[4] - p[4];
    return g;
}
// per body: x y cos sin vx vy w ax ay alpha  (slider: cos=1 etc. written too)
template <class R, class G, class D>
AI void sc_step(const SC<G>& g, double slider_y, const D& c, const D& s, const D& w, const D& al, R* o) {
    R rx = c * g.dx - s * g.dy, ry = s * g.dx + c * g.dy;
    R J2x = g.J1x + rx, J2y = g.J1y + ry;
    R h = g.J3y - J2y, e = vsqrt(g.l2 - h * h), ie = 1.0 / e;
    R cb = e * g.uxl + h * g.uyl, sb = h * g.uxl - e * g.uyl;
    D w2 = w * w;
    R v2x = -(w * ry), v2y = w * rx;
    R a2x = -(al * ry) - w2 * rx, a2y = al * rx - w2 * ry;
    R wb = -(v2y * ie), wb2 = wb * wb;
    R ab = (wb2 * h - a2y) * ie;
    R kx = c * g.kx - s * g.ky, ky = s * g.kx + c * g.ky;
    o[0] = g.J1x + kx; o[1] = g.J1y + ky; o[2] = c + 0.0 * kx; o[3] = s + 0.0 * kx;
    o[4] = -(w * ky); o[5] = w * kx; o[6] = w + 0.0 * kx;
    o[7] = -(al * ky) - w2 * kx; o[8] = al * kx - w2 * ky; o[9] = al + 0.0 * kx;
    R mx = cb * g.mx - sb * g.my, my = sb * g.mx + cb * g.my;
    o[10] = J2x + mx; o[11] = J2y + my; o[12] = cb; o[13] = sb;
    o[14] = v2x - wb * my; o[15] = v2y + wb * mx; o[16] = wb;
    o[17] = a2x - ab * my - wb2 * mx; o[18] = a2y + ab * mx - wb2 * my; o[19] = ab;
    R z = 0.0 * kx;
    o[20] = J2x + e + g.nx; o[21] = z + slider_y; o[22] = z + 1.0; o[23] = z;
    o[24] = v2x - wb * h; o[25] = z; o[26] = z;
    o[27] = a2x - ab * h - wb2 * e; o[28] = z; o[29] = z;
}

// ------------------------------------------------------------------ W2
template <class G> struct MP {
    V3<G> e, Oe, X1, Y1, T, a, tE, dl, u, C, f0, f1, f2;
    G P, Q, iM2, M2, Rc, D20, aTE, l2, dl2;
    double s1, s2;
};
template <class G> AI MP<G> mp_setup(const G* p, const double* F) {
    MP<G> g;
    V3<G> A = {p[0], p[1], p[2]}, B = {p[3], p[4], p[5]}, E = {p[6], p[7], p[8]}, T = {p[9], p[10], p[11]},
          S = {p[12], p[13], p[14]}, D = {p[15], p[16], p[17]}, C = {p[18], p[19], p[20]}, K = {p[21], p[22], p[23]};
    V3<G> ab = B - A; g.e = mul(1.0 / vsqrt(dot(ab, ab)), ab);
    V3<G> ae = E - A; g.Oe = A + mul(dot(ae, g.e), g.e);
    g.X1 = E - g.Oe; g.Y1 = cross(g.e, g.X1);
    g.T = T; V3<G> st = T - S; g.a = mul(1.0 / vsqrt(dot(st, st)), st);
    g.tE = T - E; g.D20 = dot(g.tE, g.tE); g.aTE = dot(g.a, g.tE);
    V3<G> w = T - g.Oe;
    g.P = 2.0 * dot(w, g.X1); g.Q = 2.0 * dot(w, g.Y1);
    g.M2 = g.P * g.P + g.Q * g.Q; g.iM2 = 1.0 / g.M2;
    g.Rc = dot(w, w) + dot(g.X1, g.X1) - g.D20;
    g.dl = D - E; g.dl2 = dot(g.dl, g.dl);
    V3<G> ck = K - C; g.u = mul(1.0 / vsqrt(dot(ck, ck)), ck); g.C = C;
    V3<G> cd = D - C; g.l2 = dot(cd, cd);
    V3<double> F0 = {F[0], F[1], F[2]}, F1 = {F[3], F[4], F[5]}, F2 = {F[6], F[7], F[8]};
    V3<G> z = mul(0.0, A);
    g.f0 = (z + F0) - g.Oe; g.f1 = (z + F1) - E; g.f2 = (z + F2) - T;
    g.s1 = val(g.Q) > 0 ? -1.0 : 1.0;
    V3<G> w2 = C - E;
    g.s2 = val(dot(g.dl, cross(g.tE, w2))) > 0 ? 1.0 : -1.0;
    return g;
}
template <class S> struct M3 { S m[9]; };
template <class S, class T> AI auto mv(const M3<S>& A, const V3<T>& x) -> V3<decltype(A.m[0] * x.x)> {
    return {A.m[0] * x.x + A.m[1] * x.y + A.m[2] * x.z, A.m[3] * x.x + A.m[4] * x.y + A.m[5] * x.z,
            A.m[6] * x.x + A.m[7] * x.y + A.m[8] * x.z};
}
template <class R> AI void put(R* o, const V3<R>& r, const M3<R>& A, const V3<R>& v, const V3<R>& w, const V3<R>& a, const V3<R>& al) {
    o[0] = r.x; o[1] = r.y; o[2] = r.z;
    for (int i = 0; i < 9; i++) o[3 + i] = A.m[i];
    o[12] = v.x; o[13] = v.y; o[14] = v.z; o[15] = w.x; o[16] = w.y; o[17] = w.z;
    o[18] = a.x; o[19] = a.y; o[20] = a.z; o[21] = al.x; o[22] = al.y; o[23] = al.z;
}
// f,q: strut length change and rack travel with first and second derivatives
template <class R, class G, class D>
AI void mp_step(const MP<G>& g, const double* F, const D* f, const D* q, R* o) {
    const D fv = f[0], fd = f[1], fdd = f[2];
    // lower arm angle: P c + Q s = R
    R Rv = g.Rc - 2.0 * (fv * g.aTE) - fv * fv;
    R disc = g.s1 * vsqrt(g.M2 - Rv * Rv);
    R c = (g.P * Rv - g.Q * disc) * g.iM2, s = (g.Q * Rv + g.P * disc) * g.iM2;
    V3<R> rad = mul(c, g.X1) + mul(s, g.Y1), Yc = mul(c, g.Y1) - mul(s, g.X1);
    V3<R> E = g.Oe + rad, TE = g.T - E;
    auto af = g.aTE + fv;
    R D2 = g.D20 + fv * (2.0 * g.aTE + fv), iD2 = 1.0 / D2, iD = vsqrt(iD2);
    V3<R> b = mul(iD, TE), b0 = mul(iD, g.tE + mul(fv, g.a));
    R h = dot(b0, g.dl);
    V3<R> rho0 = g.dl - mul(h, b0);
    R rho2 = g.dl2 - h * h;
    V3<R> C = g.C + mul(q[0], g.u), Cd = mul(q[1], g.u) + mul(0.0, E), Cdd = mul(q[2], g.u) + mul(0.0, E);
    V3<R> w2 = C - E; R hw = dot(w2, b); V3<R> wp = w2 - mul(hw, b);
    R n2 = dot(wp, wp), in2 = 1.0 / n2, dh = hw - h;
    R K = 0.5 * (n2 + dh * dh + rho2 - g.l2);
    R tau = g.s2 * (vsqrt(rho2 * n2 - K * K) * in2);
    V3<R> d = mul(K * in2, wp) + mul(tau, cross(b, wp));
    R irho2 = 1.0 / rho2;
    V3<R> bd = mul(irho2, cross(b, d)), br = cross(b0, rho0), dr = mul(irho2, d);
    M3<R> A;
    {
        const R* x[3] = {&b.x, &b.y, &b.z}; const R* y[3] = {&dr.x, &dr.y, &dr.z}; const R* z[3] = {&bd.x, &bd.y, &bd.z};
        const R* X[3] = {&b0.x, &b0.y, &b0.z}; const R* Y[3] = {&rho0.x, &rho0.y, &rho0.z}; const R* Z[3] = {&br.x, &br.y, &br.z};
        for (int i = 0; i < 3; i++) for (int j = 0; j < 3; j++) A.m[3 * i + j] = *x[i] * *X[j] + *y[i] * *Y[j] + *z[i] * *Z[j];
    }
    V3<R> dk = mul(h, b) + d;          // E -> D, current
    V3<R> dC = (E + dk) - C;
    V3<R> ah = mv(A, g.a);
    // velocity
    R TY = dot(TE, Yc), iTY = 1.0 / TY;
    R ph = -(fd * af) * iTY;
    V3<R> Ev = mul(ph, Yc);
    V3<R> g1 = mul(-fd, ah) - Ev;
    V3<R> wq = mul(iD2, cross(TE, g1));
    V3<R> bxd = cross(b, dk);
    R il = 1.0 / dot(bxd, dC);
    R lam = -(dot(Ev + cross(wq, dk) - Cd, dC)) * il;
    V3<R> w = wq + mul(lam, b);
    V3<R> vD = Ev + cross(w, dk), vr = vD - Cd;
    // acceleration
    R phd = (dot(Ev, Ev) + ph * ph * dot(TE, rad) - fdd * af - fd * fd) * iTY;
    V3<R> Ea = mul(phd, Yc) - mul(ph * ph, rad);
    V3<R> g2 = mul(-2.0 * fd, cross(w, ah)) - mul(fdd, ah) - Ea - cross(w, cross(w, TE));
    V3<R> aq = mul(iD2, cross(TE, g2));
    V3<R> aDp = Ea + cross(aq, dk) + cross(w, cross(w, dk)) - Cdd;
    R mu = -(dot(aDp, dC) + dot(vr, vr)) * il;
    V3<R> al = aq + mul(mu, b);
    // lower arm
    R c1 = 1.0 - c; M3<R> L;
    V3<R> ec = mul(c1, g.e), es = mul(s, g.e);
    L.m[0] = c + ec.x * g.e.x; L.m[1] = ec.x * g.e.y - es.z; L.m[2] = ec.x * g.e.z + es.y;
    L.m[3] = ec.y * g.e.x + es.z; L.m[4] = c + ec.y * g.e.y; L.m[5] = ec.y * g.e.z - es.x;
    L.m[6] = ec.z * g.e.x - es.y; L.m[7] = ec.z * g.e.y + es.x; L.m[8] = c + ec.z * g.e.z;
    V3<R> la = mv(L, g.f0), lw = mul(ph, g.e), lal = mul(phd, g.e);
    V3<R> lv = cross(lw, la);
    put<R>(o, g.Oe + la, L, lv, lw, cross(lal, la) + cross(lw, lv), lal);
    V3<R> ka = mv(A, g.f1), kv = cross(w, ka);
    put<R>(o + 24, E + ka, A, Ev + kv, w, Ea + cross(al, ka) + cross(w, kv), al);
    V3<R> sa = mv(A, g.f2), sv = cross(w, sa);
    put<R>(o + 48, g.T + sa, A, sv, w, cross(al, sa) + cross(w, sv), al);
    R z = 0.0 * c; M3<R> I;
    for (int i = 0; i < 9; i++) I.m[i] = (i % 4 == 0) ? z + 1.0 : z;
    V3<R> zz = {z, z, z};
    V3<double> F3 = {F[9], F[10], F[11]};
    put<R>(o + 72, (mul(q[0], g.u) + zz) + F3, I, Cd, zz, Cdd, zz);
}

// ------------------------------------------------------------------ W3: chain of N four-bar
// loops, each a general two-link dyad (nothing of the parallelogram is used): the left
// vertical bar is known, the right one and the coupler follow from two circles.
// per bar: x y cos sin vx vy w ax ay alpha (mid point)
static inline void fb_step(int N, double th, double w, double al, double* o) {
    double s, c; sincos(th, &s, &c);                 // angle from vertical
    double tx = -s, ty = c, vx = -c * w, vy = -s * w, ax = -c * al + s * w * w, ay = -s * al - c * w * w;
    auto put = [](double* q, double x, double y, double c, double s, double vx, double vy, double w, double ax, double ay, double al) {
        q[0] = x; q[1] = y; q[2] = c; q[3] = s; q[4] = vx; q[5] = vy; q[6] = w; q[7] = ax; q[8] = ay; q[9] = al; };
    put(o, 0.5 * tx, 0.5 * ty, c, s, 0.5 * vx, 0.5 * vy, w, 0.5 * ax, 0.5 * ay, al);
    double px = tx, py = ty;                         // top of the left bar, global
    for (int i = 0; i < N; i++) {
        double gx = i + 1.0, dx = gx - px, dy = -py, d2 = dx * dx + dy * dy;
        double h = __builtin_sqrt(1.0 / d2 - 0.25);  // both bars have length 1
        double cx = 0.5 * dx - h * dy, cy = 0.5 * dy + h * dx;          // coupler vector, from p
        double qx = px + cx, qy = py + cy, rx = qx - gx, ry = qy;      // right bar, from its pivot
        double idet = 1.0 / (cx * ry - cy * rx);
        // p' + wc x c = wr x r
        double wc = -(vx * rx + vy * ry) * idet, wr = -(vx * cx + vy * cy) * idet;
        double bx = ax - wc * wc * cx + wr * wr * rx, by = ay - wc * wc * cy + wr * wr * ry;
        double ac = -(bx * rx + by * ry) * idet, ar = -(bx * cx + by * cy) * idet;
        put(o + 10 * (N + 1 + i), px + 0.5 * cx, py + 0.5 * cy, cx, cy, vx - 0.5 * wc * cy, vy + 0.5 * wc * cx, wc, ax - 0.5 * (ac * cy + wc * wc * cx), ay + 0.5 * (ac * cx - wc * wc * cy), ac);
        vx = -wr * ry; vy = wr * rx; ax = -ar * ry - wr * wr * rx; ay = ar * rx - wr * wr * ry;
        put(o + 10 * (i + 1), gx + 0.5 * rx, 0.5 * ry, ry, -rx, 0.5 * vx, 0.5 * vy, wr, 0.5 * ax, 0.5 * ay, ar);
        px = qx; py = qy;
    }
}

// ------------------------------------------------------------------ W2, Newton on the
// four relative coordinates that remain after cutting E and the tie rod (the seed
// paper's formulation): arm angle phi and the spherical-joint rotation of the strut.
struct MPN { double phi, qt[4], phd, w[3], phdd, al[3]; int iters; double res; };
AI bool lu4(double J[4][4], int* pv) {
    for (int k = 0; k < 4; k++) {
        int m = k; double best = fabs(J[k][k]);
        for (int i = k + 1; i < 4; i++) if (fabs(J[i][k]) > best) { best = fabs(J[i][k]); m = i; }
        pv[k] = m;
        if (m != k) for (int j = 0; j < 4; j++) { double t = J[k][j]; J[k][j] = J[m][j]; J[m][j] = t; }
        double ip = 1.0 / J[k][k]; 
        for (int i = k + 1; i < 4; i++) { J[i][k] *= ip; for (int j = k + 1; j < 4; j++) J[i][j] -= J[i][k] * J[k][j]; }
    }
    return true;
}
AI void ls4(const double J[4][4], const int* pv, double* x) {
    for (int k = 0; k < 4; k++) { double t = x[k]; x[k] = x[pv[k]]; x[pv[k]] = t; for (int i = k + 1; i < 4; i++) x[i] -= J[i][k] * x[k]; }
    for (int k = 3; k >= 0; k--) { for (int j = k + 1; j < 4; j++) x[k] -= J[k][j] * x[j]; x[k] /= J[k][k]; }
}
AI void qrot(double* q, double x, double y, double z) {   // q <- exp([x y z]) q, normalised
    double n2 = 0.25 * (x * x + y * y + z * z);
    double s = 0.5 * (1.0 - n2 / 6.0 + n2 * n2 / 120.0 - n2 * n2 * n2 / 5040.0), c = 1.0 - n2 / 2.0 + n2 * n2 / 24.0 - n2 * n2 * n2 / 720.0;
    x *= s; y *= s; z *= s;
    double a = c * q[0] - x * q[1] - y * q[2] - z * q[3], b = c * q[1] + x * q[0] + y * q[3] - z * q[2],
           d = c * q[2] + y * q[0] + z * q[1] - x * q[3], e = c * q[3] + z * q[0] + x * q[2] - y * q[1];
    double in = 1.0 / __builtin_sqrt(a * a + b * b + d * d + e * e);
    q[0] = a * in; q[1] = b * in; q[2] = d * in; q[3] = e * in;
}
static inline void mpn_step(const MP<double>& g, const double* F, const double* f, const double* q, double dt, double tol, MPN& S, double* o) {
    typedef V3<double> V;
    // predictor
    S.phi += S.phd * dt + 0.5 * S.phdd * dt * dt;
    double h2 = 0.5 * dt * dt;
    qrot(S.qt, S.w[0] * dt + S.al[0] * h2, S.w[1] * dt + S.al[1] * h2, S.w[2] * dt + S.al[2] * h2);
    double J[4][4]; int pv[4]; M3<double> A; V rad, Yc, E, eT, dk, dC, C = g.C + mul(q[0], g.u), Ek;
    double c, s;
    V eloc = mul(-1.0, g.tE + mul(f[0], g.a));      // T'->E, knuckle frame
    V dloc = g.dl + eloc;                           // T'->D
    int it = 0; double err;
    for (;; it++) {
        c = cos(S.phi); s = sin(S.phi);
        rad = mul(c, g.X1) + mul(s, g.Y1); Yc = mul(c, g.Y1) - mul(s, g.X1); E = g.Oe + rad;
        double e0 = S.qt[0], e1 = S.qt[1], e2 = S.qt[2], e3 = S.qt[3];
        A.m[0] = 1 - 2 * (e2 * e2 + e3 * e3); A.m[1] = 2 * (e1 * e2 - e0 * e3); A.m[2] = 2 * (e1 * e3 + e0 * e2);
        A.m[3] = 2 * (e1 * e2 + e0 * e3); A.m[4] = 1 - 2 * (e1 * e1 + e3 * e3); A.m[5] = 2 * (e2 * e3 - e0 * e1);
        A.m[6] = 2 * (e1 * e3 - e0 * e2); A.m[7] = 2 * (e2 * e3 + e0 * e1); A.m[8] = 1 - 2 * (e1 * e1 + e2 * e2);
        eT = mv(A, eloc); V dT = mv(A, dloc); Ek = g.T + eT; V Dp = g.T + dT; dC = Dp - C;
        V r1 = Ek - E; double r2 = 0.5 * (dot(dC, dC) - g.l2);
        err = fmax(fmax(fabs(r1.x), fabs(r1.y)), fmax(fabs(r1.z), fabs(r2)));
        // rows: -Yc dphi + dth x eT = -r1 ; (dT x dC).dth = -r2
        V m = cross(dT, dC);
        double JJ[4][4] = {{-Yc.x, 0, eT.z, -eT.y}, {-Yc.y, -eT.z, 0, eT.x}, {-Yc.z, eT.y, -eT.x, 0}, {0, m.x, m.y, m.z}};
        __builtin_memcpy(J, JJ, sizeof J);
        dk = dT - eT;
        lu4(J, pv);
        if (err < tol || it >= 20) break;
        double x[4] = {-r1.x, -r1.y, -r1.z, -r2};
        ls4(J, pv, x);
        S.phi += x[0]; qrot(S.qt, x[1], x[2], x[3]);
    }
    S.iters = it; S.res = err;
    V ah = mv(A, g.a);
    V dT = dk + eT, Cd = mul(q[1], g.u), Cdd = mul(q[2], g.u);
    // material point of knuckle at T moves with -fd*ah
    V r1 = mul(-f[1], ah);
    double x[4] = {-r1.x, -r1.y, -r1.z, -dot(r1 - Cd, dC)};
    ls4(J, pv, x);
    double ph = x[0]; V w = {x[1], x[2], x[3]};
    V Ev = mul(ph, Yc), vD = r1 + cross(w, dT), vr = vD - Cd;
    V at = mul(-2.0 * f[1], cross(w, ah)) - mul(f[2], ah);
    V be = at + cross(w, cross(w, eT)) + mul(ph * ph, rad);
    V bd = at + cross(w, cross(w, dT)) - Cdd;
    double y[4] = {-be.x, -be.y, -be.z, -dot(bd, dC) - dot(vr, vr)};
    ls4(J, pv, y);
    double phd = y[0]; V al = {y[1], y[2], y[3]};
    V Ea = mul(phd, Yc) - mul(ph * ph, rad);
    S.phd = ph; S.phdd = phd; S.w[0] = w.x; S.w[1] = w.y; S.w[2] = w.z; S.al[0] = al.x; S.al[1] = al.y; S.al[2] = al.z;
    double c1 = 1.0 - c; M3<double> L; V ec = mul(c1, g.e), es = mul(s, g.e);
    L.m[0] = c + ec.x * g.e.x; L.m[1] = ec.x * g.e.y - es.z; L.m[2] = ec.x * g.e.z + es.y;
    L.m[3] = ec.y * g.e.x + es.z; L.m[4] = c + ec.y * g.e.y; L.m[5] = ec.y * g.e.z - es.x;
    L.m[6] = ec.z * g.e.x - es.y; L.m[7] = ec.z * g.e.y + es.x; L.m[8] = c + ec.z * g.e.z;
    V la = mv(L, g.f0), lw = mul(ph, g.e), lal = mul(phd, g.e), lv = cross(lw, la);
    put<double>(o, g.Oe + la, L, lv, lw, cross(lal, la) + cross(lw, lv), lal);
    V ka = mv(A, g.f1), kv = cross(w, ka);
    put<double>(o + 24, Ek + ka, A, Ev + kv, w, Ea + cross(al, ka) + cross(w, kv), al);
    V sa = mv(A, g.f2), sv = cross(w, sa);
    put<double>(o + 48, g.T + sa, A, sv, w, cross(al, sa) + cross(w, sv), al);
    M3<double> I = {{1, 0, 0, 0, 1, 0, 0, 0, 1}}; V zz = {0, 0, 0}, F3 = {F[9], F[10], F[11]};
    put<double>(o + 72, F3 + mul(q[0], g.u), I, Cd, zz, Cdd, zz);
}
// the same with eight designs in the lanes; 4x4 elimination in a fixed row order
struct MPN8 { v8d phi, qt[4], phd, w[3], phdd, al[3]; int iters; double res; };
AI void lu4v(v8d J[4][4]) { for (int k = 0; k < 4; k++) { v8d ip = 1.0 / J[k][k]; for (int i = k + 1; i < 4; i++) { J[i][k] = J[i][k] * ip; for (int j = k + 1; j < 4; j++) J[i][j] -= J[i][k] * J[k][j]; } J[k][k] = ip; } }
AI void ls4v(const v8d J[4][4], v8d* x) { for (int k = 0; k < 4; k++) for (int i = k + 1; i < 4; i++) x[i] -= J[i][k] * x[k]; for (int k = 3; k >= 0; k--) { for (int j = k + 1; j < 4; j++) x[k] -= J[k][j] * x[j]; x[k] = x[k] * J[k][k]; } }
AI void qrotv(v8d* q, v8d x, v8d y, v8d z) {
    v8d n2 = 0.25 * (x * x + y * y + z * z), s = 0.5 * (1.0 - n2 * (1 / 6.0) + n2 * n2 * (1 / 120.0) - n2 * n2 * n2 * (1 / 5040.0)), c = 1.0 - n2 * 0.5 + n2 * n2 * (1 / 24.0) - n2 * n2 * n2 * (1 / 720.0);
    x *= s; y *= s; z *= s;
    v8d a = c * q[0] - x * q[1] - y * q[2] - z * q[3], b = c * q[1] + x * q[0] + y * q[3] - z * q[2], d = c * q[2] + y * q[0] + z * q[1] - x * q[3], e = c * q[3] + z * q[0] + x * q[2] - y * q[1];
    v8d in = 1.0 / vsqrt(a * a + b * b + d * d + e * e);
    q[0] = a * in; q[1] = b * in; q[2] = d * in; q[3] = e * in;
}
static inline void mpn_step8(const MP<v8d>& g, const double* F, const double* f, const double* q, double dt, double tol, MPN8& S, v8d* o) {
    typedef V3<v8d> V; typedef v8d R;
    // predictor
    S.phi += S.phd * dt + 0.5 * S.phdd * dt * dt;
    double h2 = 0.5 * dt * dt;
    qrotv(S.qt, S.w[0] * dt + S.al[0] * h2, S.w[1] * dt + S.al[1] * h2, S.w[2] * dt + S.al[2] * h2);
    v8d J[4][4]; M3<v8d> A; V rad, Yc, E, eT, dk, dC, C = g.C + mul(q[0], g.u), Ek;
    v8d c, s;
    V eloc = mul(-1.0, g.tE + mul(f[0], g.a));      // T'->E, knuckle frame
    V dloc = g.dl + eloc;                           // T'->D
    int it = 0; double err;
    for (;; it++) {
        c = vcos(S.phi); s = vsin(S.phi);
        rad = mul(c, g.X1) + mul(s, g.Y1); Yc = mul(c, g.Y1) - mul(s, g.X1); E = g.Oe + rad;
        v8d e0 = S.qt[0], e1 = S.qt[1], e2 = S.qt[2], e3 = S.qt[3];
        A.m[0] = 1 - 2 * (e2 * e2 + e3 * e3); A.m[1] = 2 * (e1 * e2 - e0 * e3); A.m[2] = 2 * (e1 * e3 + e0 * e2);
        A.m[3] = 2 * (e1 * e2 + e0 * e3); A.m[4] = 1 - 2 * (e1 * e1 + e3 * e3); A.m[5] = 2 * (e2 * e3 - e0 * e1);
        A.m[6] = 2 * (e1 * e3 - e0 * e2); A.m[7] = 2 * (e2 * e3 + e0 * e1); A.m[8] = 1 - 2 * (e1 * e1 + e2 * e2);
        eT = mv(A, eloc); V dT = mv(A, dloc); Ek = g.T + eT; V Dp = g.T + dT; dC = Dp - C;
        V r1 = Ek - E; v8d r2 = 0.5 * (dot(dC, dC) - g.l2);
        err = fmax(fmax(maxabs(r1.x), maxabs(r1.y)), fmax(maxabs(r1.z), maxabs(r2)));
        // rows: -Yc dphi + dth x eT = -r1 ; (dT x dC).dth = -r2
        V m = cross(dT, dC);
        v8d Z = {}; v8d JJ[4][4] = {{-Yc.z, eT.y, -eT.x, Z}, {-Yc.y, -eT.z, Z, eT.x}, {-Yc.x, Z, eT.z, -eT.y}, {Z, m.x, m.y, m.z}};
        __builtin_memcpy(J, JJ, sizeof J);
        dk = dT - eT;
        lu4v(J);
        if (err < tol || it >= 20) break;
        v8d x[4] = {-r1.z, -r1.y, -r1.x, -r2};
        ls4v(J, x);
        S.phi += x[0]; qrotv(S.qt, x[1], x[2], x[3]);
    }
    S.iters = it; S.res = err;
    V ah = mv(A, g.a);
    V dT = dk + eT, Cd = mul(q[1], g.u), Cdd = mul(q[2], g.u);
    // material point of knuckle at T moves with -fd*ah
    V r1 = mul(-f[1], ah);
    v8d x[4] = {-r1.z, -r1.y, -r1.x, -dot(r1 - Cd, dC)};
    ls4v(J, x);
    v8d ph = x[0]; V w = {x[1], x[2], x[3]};
    V Ev = mul(ph, Yc), vD = r1 + cross(w, dT), vr = vD - Cd;
    V at = mul(-2.0 * f[1], cross(w, ah)) - mul(f[2], ah);
    V be = at + cross(w, cross(w, eT)) + mul(ph * ph, rad);
    V bd = at + cross(w, cross(w, dT)) - Cdd;
    v8d y[4] = {-be.z, -be.y, -be.x, -dot(bd, dC) - dot(vr, vr)};
    ls4v(J, y);
    v8d phd = y[0]; V al = {y[1], y[2], y[3]};
    V Ea = mul(phd, Yc) - mul(ph * ph, rad);
    S.phd = ph; S.phdd = phd; S.w[0] = w.x; S.w[1] = w.y; S.w[2] = w.z; S.al[0] = al.x; S.al[1] = al.y; S.al[2] = al.z;
    v8d c1 = 1.0 - c; M3<v8d> L; V ec = mul(c1, g.e), es = mul(s, g.e);
    L.m[0] = c + ec.x * g.e.x; L.m[1] = ec.x * g.e.y - es.z; L.m[2] = ec.x * g.e.z + es.y;
    L.m[3] = ec.y * g.e.x + es.z; L.m[4] = c + ec.y * g.e.y; L.m[5] = ec.y * g.e.z - es.x;
    L.m[6] = ec.z * g.e.x - es.y; L.m[7] = ec.z * g.e.y + es.x; L.m[8] = c + ec.z * g.e.z;
    V la = mv(L, g.f0), lw = mul(ph, g.e), lal = mul(phd, g.e), lv = cross(lw, la);
    put<v8d>(o, g.Oe + la, L, lv, lw, cross(lal, la) + cross(lw, lv), lal);
    V ka = mv(A, g.f1), kv = cross(w, ka);
    put<v8d>(o + 24, Ek + ka, A, Ev + kv, w, Ea + cross(al, ka) + cross(w, kv), al);
    V sa = mv(A, g.f2), sv = cross(w, sa);
    put<v8d>(o + 48, g.T + sa, A, sv, w, cross(al, sa) + cross(w, sv), al);
    v8d z = {}; M3<v8d> I; for (int i = 0; i < 9; i++) I.m[i] = (i % 4 == 0) ? z + 1.0 : z; V zz = {z, z, z}, F3 = {z + F[9], z + F[10], z + F[11]};
    put<v8d>(o + 72, F3 + mul(q[0], g.u), I, Cd, zz, Cdd, zz);
}
