// Times the floor kernels and writes the reference trajectories.
// usage: floor <data.txt> <output folder> [repetitions]
#include "kernels.hpp"
#include <algorithm>
#include <ctime>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>
using std::vector;
// CPU time of this process: the machine is shared
static double now() { timespec t; clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t); return t.tv_sec + 1e-9 * t.tv_nsec; }
struct Rep { vector<double> t; double med() { std::sort(t.begin(), t.end()); return t[t.size() / 2]; } };
static void dump(const std::string& d, const char* n, const double* p, size_t k) {
    FILE* f = fopen((d + "/ref_" + n + ".f64").c_str(), "wb"); fwrite(p, 8, k, f); fclose(f);
}
static void line(const char* k, const char* wl, double us, const char* extra = "") {
    printf("{\"peer\": \"%s\", \"workload\": \"%s\", \"us_per_step\": %.5g%s}\n", k, wl, us, extra); fflush(stdout);
}
static inline void sincos_d(double x, double& s, double& c) { sincos(x, &s, &c); }

int main(int argc, char** argv) {
    FILE* fi = fopen(argv[1], "r"); std::string out = argv[2];
    auto rd = [&](int n) { vector<double> v(n); for (auto& x : v) if (fscanf(fi, "%lf", &x) != 1) abort(); return v; };
    auto cfg = rd(11);   // n1 T1 n2 T2 strutA strutHz rackA rackHz nd n4 T4
    int n1 = cfg[0], n2 = cfg[2], nd = cfg[8], n4 = cfg[9];
    auto p1 = rd(6), F1 = rd(6), p2 = rd(24), F2 = rd(12), des = rd(24 * nd);
    const double tp = 6.283185307179586476925286766559;
    const int NREP = argc > 3 ? atoi(argv[3]) : 41, FEW = NREP < 5 ? NREP : 5;
    auto bench = [&](auto&& f) { Rep r; f(); for (int i = 0; i < NREP; i++) { double t = now(); f(); r.t.push_back(now() - t); } return r.med(); };

    // ---------------- W1 scalar
    vector<double> o1(n1 * 30);
    auto w1 = [&] {
        SC<double> g = sc_setup<double>(p1.data(), F1.data());
        for (int k = 0; k < n1; k++) {
            double t = cfg[1] * k / (n1 - 1), s0, c0, s, c; sincos_d(tp * t, s0, c0); sincos_d(s0, s, c);
            sc_step<double, double, double>(g, F1[5], c, s, tp * c0, -tp * tp * s0, &o1[k * 30]);
        }
    };
    line("floor-closed-form", "W1", bench(w1) / n1 * 1e6, ", \"note\": \"scalar C++, incl. both sincos\"");
    vector<v8d> o1v((n1 + 7) / 8 * 30); vector<double> o1b(n1 * 30);
    auto w1v = [&] {
        SC<double> g = sc_setup<double>(p1.data(), F1.data());
        v8d lane = {0, 1, 2, 3, 4, 5, 6, 7};
        for (int k = 0; k < n1; k += 8) {
            v8d t = (lane + (double)k) * (cfg[1] / (n1 - 1));
            v8d s0 = vsin(tp * t), c0 = vcos(tp * t), s = vsin(s0), c = vcos(s0);
            sc_step<v8d, double, v8d>(g, F1[5], c, s, tp * c0, -tp * tp * s0, &o1v[k / 8 * 30]);
        }
    };
    line("floor-closed-form-lanes", "W1", bench(w1v) / n1 * 1e6, ", \"note\": \"8 time steps per lane group, structure of arrays\"");
    // ---------------- W1s
    vector<Dual<1>> o1d(n1 * 30);
    auto w1s = [&] {
        Dual<1> p[6]; for (int i = 0; i < 6; i++) { p[i] = Dual<1>(p1[i]); p[i].d[0][i] = 1; }
        SC<Dual<1>> g = sc_setup<Dual<1>>(p, F1.data());
        for (int k = 0; k < n1; k++) {
            double t = cfg[1] * k / (n1 - 1), s0, c0, s, c; sincos_d(tp * t, s0, c0); sincos_d(s0, s, c);
            sc_step<Dual<1>, Dual<1>, double>(g, F1[5], c, s, tp * c0, -tp * tp * s0, &o1d[k * 30]);
        }
    };
    line("floor-closed-form", "W1s", bench(w1s) / n1 * 1e6, ", \"note\": \"forward AD, 6 derivatives of all outputs\"");
    {   // expand to 24-per-body layout
        vector<double> r(n1 * 72, 0.0), rs((size_t)n1 * 72 * 6, 0.0);
        auto put = [&](size_t k, int b, int j, int src) {
            r[k * 72 + b * 24 + j] = o1d[k * 30 + b * 10 + src].v;
            for (int m = 0; m < 6; m++) rs[(k * 72 + b * 24 + j) * 6 + m] = o1d[k * 30 + b * 10 + src].d[0][m];
        };
        for (int k = 0; k < n1; k++) for (int b = 0; b < 3; b++) {
            put(k, b, 0, 0); put(k, b, 1, 1); put(k, b, 3, 2); put(k, b, 6, 3); put(k, b, 7, 2); put(k, b, 12, 4); put(k, b, 13, 5);
            put(k, b, 17, 6); put(k, b, 18, 7); put(k, b, 19, 8); put(k, b, 23, 9);
            r[k * 72 + b * 24 + 4] = -r[k * 72 + b * 24 + 6]; r[k * 72 + b * 24 + 11] = 1;
            for (int m = 0; m < 6; m++) rs[(k * 72 + b * 24 + 4) * 6 + m] = -rs[(k * 72 + b * 24 + 6) * 6 + m];
        }
        dump(out, "W1", r.data(), r.size()); dump(out, "W1S", rs.data(), rs.size());
        double md = 0; for (int k = 0; k < n1 * 30; k++) md = fmax(md, fmax(fabs(o1[k] - o1d[k].v), fabs(((double*)&o1v[k / 30 / 8 * 30 + k % 30])[k / 30 % 8] - o1[k])));
        fprintf(stderr, "W1 scalar/avx/dual max difference %.2e\n", md);
    }
    // ---------------- W2
    auto drv = [&](double t, double* f, double* q) {
        double ws = tp * cfg[5], wr = tp * cfg[7], s, c;
        sincos_d(ws * t, s, c); f[0] = cfg[4] * s; f[1] = cfg[4] * ws * c; f[2] = -cfg[4] * ws * ws * s;
        sincos_d(wr * t, s, c); q[0] = cfg[6] * s; q[1] = cfg[6] * wr * c; q[2] = -cfg[6] * wr * wr * s;
    };
    vector<double> o2(n2 * 96), o2n(n2 * 96);
    auto w2 = [&] {
        MP<double> g = mp_setup<double>(p2.data(), F2.data());
        for (int k = 0; k < n2; k++) { double f[3], q[3]; drv(cfg[3] * k / (n2 - 1), f, q); mp_step<double, double, double>(g, F2.data(), f, q, &o2[k * 96]); }
    };
    line("floor-closed-form", "W2", bench(w2) / n2 * 1e6, ", \"note\": \"two circle-sphere intersections, scalar\"");
    vector<v8d> o2v((n2 + 7) / 8 * 96);
    auto w2v = [&] {
        MP<double> g = mp_setup<double>(p2.data(), F2.data());
        v8d lane = {0, 1, 2, 3, 4, 5, 6, 7}; double ws = tp * cfg[5], wr = tp * cfg[7];
        for (int k = 0; k < n2; k += 8) {
            v8d t = (lane + (double)k) * (cfg[3] / (n2 - 1));
            v8d s = vsin(ws * t), c = vcos(ws * t), f[3] = {cfg[4] * s, cfg[4] * ws * c, -cfg[4] * ws * ws * s};
            s = vsin(wr * t); c = vcos(wr * t);
            v8d q[3] = {cfg[6] * s, cfg[6] * wr * c, -cfg[6] * wr * wr * s};
            mp_step<v8d, double, v8d>(g, F2.data(), f, q, &o2v[k / 8 * 96]);
        }
    };
    line("floor-closed-form-lanes", "W2", bench(w2v) / n2 * 1e6, ", \"note\": \"8 time steps at once\"");
    double itmean = 0, resmax = 0;
    auto w2n = [&] {
        MP<double> g = mp_setup<double>(p2.data(), F2.data()); MPN S = {}; S.qt[0] = 1; itmean = 0; resmax = 0;
        for (int k = 0; k < n2; k++) {
            double f[3], q[3]; drv(cfg[3] * k / (n2 - 1), f, q);
            mpn_step(g, F2.data(), f, q, k ? cfg[3] / (n2 - 1) : 0.0, 1e-12, S, &o2n[k * 96]);
            itmean += S.iters; resmax = fmax(resmax, S.res);
        }
        itmean /= n2;
    };
    double tn = bench(w2n); char ex[256];
    double md = 0; for (size_t i = 0; i < o2.size(); i++) md = fmax(md, fabs(o2[i] - o2n[i]));
    snprintf(ex, sizeof ex, ", \"newton_iters_mean\": %.3g, \"residual\": %.2g, \"max_diff_to_closed_form\": %.2g, \"note\": \"4 relative coordinates, 2 cut joints, predictor\"", itmean, resmax, md);
    line("floor-newton4", "W2", tn / n2 * 1e6, ex);
    // ---------------- W2s
    typedef Dual<3> D24; vector<D24> o2d((size_t)n2 * 96), ob(96);
    auto mk = [&] { D24 p[24]; for (int i = 0; i < 24; i++) { p[i] = D24(p2[i]); p[i].d[i / 8][i % 8] = 1; } return mp_setup<D24>(p, F2.data()); };
    auto w2s = [&] {
        MP<D24> g = mk();
        for (int k = 0; k < n2; k++) { double f[3], q[3]; drv(cfg[3] * k / (n2 - 1), f, q); mp_step<D24, D24, double>(g, F2.data(), f, q, &o2d[(size_t)k * 96]); }
    };
    line("floor-closed-form", "W2s", bench(w2s) / n2 * 1e6, ", \"note\": \"forward AD, 24 derivatives of all 96 outputs, stored (18 kB/step)\"");
    auto w2sb = [&] {
        MP<D24> g = mk();
        for (int k = 0; k < n2; k++) { double f[3], q[3]; drv(cfg[3] * k / (n2 - 1), f, q); mp_step<D24, D24, double>(g, F2.data(), f, q, ob.data()); asm volatile("" ::"r"(ob.data()) : "memory"); }
    };
    line("floor-closed-form-nostore", "W2s", bench(w2sb) / n2 * 1e6, ", \"note\": \"same, into a reused buffer\"");
    {
        vector<double> rs((size_t)n2 * 96 * 24);
        for (size_t i = 0; i < (size_t)n2 * 96; i++) for (int m = 0; m < 24; m++) rs[i * 24 + m] = o2d[i].d[m / 8][m % 8];
        dump(out, "W2", o2.data(), o2.size()); dump(out, "W2S", rs.data(), rs.size());
        double m2 = 0; for (size_t i = 0; i < (size_t)n2 * 96; i++) m2 = fmax(m2, fmax(fabs(o2[i] - o2d[i].v), fabs(((double*)&o2v[i / 96 / 8 * 96 + i % 96])[i / 96 % 8] - o2[i])));
        fprintf(stderr, "W2 scalar/avx/dual max difference %.2e\n", m2);
    }
    // ---------------- W3
    for (int N : {1, 10, 100, 1000}) {
        int n3 = 201; vector<double> o3((size_t)n3 * (2 * N + 1) * 10);
        auto w3 = [&] { for (int k = 0; k < n3; k++) { double t = 2.0 * k / (n3 - 1), s, c; sincos_d(tp * t, s, c); fb_step(N, 0.5 * s, 0.5 * tp * c, -0.5 * tp * tp * s, &o3[(size_t)k * (2 * N + 1) * 10]); } };
        double t3 = bench(w3), e = 0;
        for (int k = 0; k < n3; k++) { double* o = &o3[(size_t)k * (2 * N + 1) * 10]; for (int b = 1; b <= N; b++) for (int j = 1; j < 10; j++) e = fmax(e, fabs(o[10 * b + j] - o[j])); for (int b = N + 1; b < 2 * N + 1; b++) e = fmax(e, fmax(fabs(o[10 * b + 6]), fabs(o[10 * b + 9]))); }
        char b[128]; snprintf(b, 128, ", \"max_diff_between_loops\": %.2g", e); line("floor-closed-form", ("W3-" + std::to_string(N)).c_str(), t3 / n3 * 1e6, b);
    }
    // ---------------- W4
    vector<double> f4(n4 * 3), q4(n4 * 3); for (int k = 0; k < n4; k++) drv(cfg[10] * k / (n4 - 1), &f4[3 * k], &q4[3 * k]);
    vector<double> o4((size_t)nd * n4 * 96);
    auto w4 = [&] {
        for (int i = 0; i < nd; i++) {
            MP<double> g = mp_setup<double>(&des[24 * i], F2.data());
            for (int k = 0; k < n4; k++) mp_step<double, double, double>(g, F2.data(), &f4[3 * k], &q4[3 * k], &o4[((size_t)i * n4 + k) * 96]);
        }
    };
    auto rate = [&](double t, char* b) { snprintf(b, 256, ", \"designs_steps_per_s\": %.4g", (double)nd * n4 / t); };
    Rep r4; for (int i = 0; i < FEW; i++) { double t = now(); w4(); r4.t.push_back(now() - t); }
    double t4 = r4.med(); rate(t4, ex); line("floor-closed-form", "W4", t4 / nd / n4 * 1e6, ex);
    dump(out, "W4", o4.data(), o4.size());
    // ---------------- W4s: into a reused buffer; the first eight designs are kept for comparison
    auto w4s = [&](int first, int last, auto&& keep) {
        for (int i = first; i < last; i++) {
            D24 p[24]; for (int j = 0; j < 24; j++) { p[j] = D24(des[24 * i + j]); p[j].d[j / 8][j % 8] = 1; }
            MP<D24> g = mp_setup<D24>(p, F2.data());
            for (int k = 0; k < n4; k++) { mp_step<D24, D24, double>(g, F2.data(), &f4[3 * k], &q4[3 * k], ob.data()); keep(i, k); }
        }
    };
    Rep rs; for (int i = 0; i < FEW; i++) { double t = now(); w4s(0, nd, [&](int, int) { asm volatile("" ::"r"(ob.data()) : "memory"); }); rs.t.push_back(now() - t); }
    double ts = rs.med(); rate(ts, ex); line("floor-closed-form-nostore", "W4s", ts / nd / n4 * 1e6, ex);
    {
        vector<double> r4s((size_t)8 * n4 * 96 * 24);
        w4s(0, 8, [&](int i, int k) { for (int j = 0; j < 96; j++) for (int m = 0; m < 24; m++) r4s[(((size_t)i * n4 + k) * 96 + j) * 24 + m] = ob[j].d[m / 8][m % 8]; });
        dump(out, "W4S", r4s.data(), r4s.size());
    }
    vector<v8d> ov(96);
    auto w4v = [&] {
        for (int i = 0; i < nd; i += 8) {
            v8d p[24]; for (int j = 0; j < 24; j++) for (int l = 0; l < 8; l++) p[j][l] = des[24 * (i + l) + j];
            MP<v8d> g = mp_setup<v8d>(p, F2.data());
            for (int k = 0; k < n4; k++) { mp_step<v8d, v8d, double>(g, F2.data(), &f4[3 * k], &q4[3 * k], ov.data()); asm volatile("" ::"r"(ov.data()) : "memory"); }
        }
    };
    double t4v = bench(w4v); rate(t4v, ex); line("floor-closed-form-lanes", "W4", t4v / nd / n4 * 1e6, ex);
    auto w4n = [&] {
        for (int i = 0; i < nd; i++) {
            MP<double> g = mp_setup<double>(&des[24 * i], F2.data()); MPN S = {}; S.qt[0] = 1;
            for (int k = 0; k < n4; k++) mpn_step(g, F2.data(), &f4[3 * k], &q4[3 * k], k ? cfg[10] / (n4 - 1) : 0.0, 1e-12, S, &o2n[0]);
        }
    };
    Rep r5; for (int i = 0; i < FEW; i++) { double t = now(); w4n(); r5.t.push_back(now() - t); }
    double t5 = r5.med(); rate(t5, ex); line("floor-newton4", "W4", t5 / nd / n4 * 1e6, ex);
    auto w4n8 = [&] {
        for (int i = 0; i < nd; i += 8) {
            v8d p[24]; for (int j = 0; j < 24; j++) for (int l = 0; l < 8; l++) p[j][l] = des[24 * (i + l) + j];
            MP<v8d> g = mp_setup<v8d>(p, F2.data()); MPN8 S; v8d z = {}; S.phi = S.phd = S.phdd = z; for (int k = 0; k < 3; k++) S.w[k] = S.al[k] = z; for (int k = 0; k < 4; k++) S.qt[k] = z; S.qt[0] = z + 1.0;
            for (int k = 0; k < n4; k++) { mpn_step8(g, F2.data(), &f4[3 * k], &q4[3 * k], k ? cfg[10] / (n4 - 1) : 0.0, 1e-12, S, ov.data()); asm volatile("" ::"r"(ov.data()) : "memory"); }
        }
    };
    double t8 = bench(w4n8); rate(t8, ex); double e8 = 0; for (int j = 0; j < 96; j++) for (int l = 0; l < 8; l++) e8 = fmax(e8, fabs(ov[j][l] - o4[((size_t)(nd - 8 + l) * n4 + n4 - 1) * 96 + j]));
    size_t le = strlen(ex); snprintf(ex + le, sizeof ex - le, ", \"max_diff_to_closed_form\": %.2g", e8);
    line("floor-newton4-lanes", "W4", t8 / nd / n4 * 1e6, ex);
    return 0;
}
