"""What Python costs: import, a call, a design, an output time; and the designs of the strut sweep beside the same by what an engineer would
write in Python with CasADi (`map`) and with Pinocchio's Python API. `bench/python` prepares and runs it.

The sweep: N designs of `models/studies/strut_sweep.toml` (Sobol points within its bounds), both cases of each, 81 and 61 output times; positions,
velocities, and toe at each. CasADi: the four relative coordinates and formulas of sweep_casadi.py, three Newton corrections a step (fixed, since a
map cannot decide), `mapaccum` over the output times and `map` over the designs. Pinocchio: a model built for each design, the ball joint and the tie
rod closed by Newton with Jacobians of frames, all in Python; of it fewer designs are run.
"""
import json
import subprocess
import sys
import time

import numpy as np

import hardpoint

SWEEP = "models/studies/strut_sweep.toml"
CASES = {"bump": (80, -40.0, 0.0), "steer": (60, 0.0, 30.0)}
LENGTHS = [100, 500, 2500]


def best(work, least=0.3):
    """seconds of one call, the least of many"""
    work()
    times, begun = [], time.perf_counter()
    while time.perf_counter() - begun < least or len(times) < 5:
        t = time.perf_counter()
        work()
        times.append(time.perf_counter() - t)
    return min(times)


def now():
    return time.perf_counter(), time.process_time()


def since(begun):
    """seconds since then, of the clock and of all threads"""
    wall, cpu = now()
    return dict(wall=wall - begun[0], cpu=cpu - begun[1])


def imports():
    """ms of a process that imports something, beyond one that does nothing"""
    def process(code):
        return best(lambda: subprocess.run([sys.executable, "-c", code], check=True), 2)
    nothing = process("pass")
    return {name: 1e3*(process("import " + name) - nothing) for name in ["numpy", "hardpoint", "pandas"]}


def rust(repeat, what, times):
    """us per output time of the same in Rust"""
    runs = [subprocess.run([repeat, "macpherson", what, str(times)], check=True, capture_output=True, text=True).stdout for _ in range(5)]
    return min(float(line.split(", ")[1].split()[0]) for line in runs)


def calls(repeat):
    model = hardpoint.read("models/macpherson.toml")
    steps, rows = len(model.times()), {}
    for what, sensitivities, times in [("values", False, 400), ("all", True, 200)]:
        call = best(lambda: model.run(sensitivities=sensitivities))
        with_array = best(lambda: model.run(sensitivities=sensitivities).values("toe"))
        rows[what] = dict(python=1e6*call/steps, array=1e6*with_array/steps, rust=rust(repeat, what, times))
    sized = [model.text.replace("steps = 500", "steps = %d" % n) for n in LENGTHS]
    assert len(set(sized)) == len(LENGTHS)
    short = [best(lambda m=m: m.run(sensitivities=False)) for m in map(hardpoint.parse, sized)]
    slope, call = np.polyfit(np.array(LENGTHS) + 1.0, short, 1)
    designs = np.arange(1000)[:, None]*1e-3
    first = list(model.variables)[0]
    many = best(lambda: model.designs(designs, ["toe"], variables=[first], sensitivities=False, metrics=False, workers=1), 2)
    rows["sweep"] = dict(python=1e6*many/1000/steps, rust=rust(repeat, "sweep", 2))
    kept = model.run()
    rows["facts"] = dict(call=1e6*call, per_step=1e6*slope, again=1e6*best(lambda: kept.values("toe")), steps=steps)
    return rows


# ------------------------------------------------------------------ the sweep

def designs_of(model, count):
    """the variables of the sweep, and a row for each design"""
    table = {column.split(" [")[0]: cells for column, cells in model.sweep(samples=count).columns.items()}
    swept = [name for name in model.variables if name in table]
    return swept, np.column_stack([table[name] for name in swept])


def points(swept, rows):
    """the hardpoints of each design"""
    import sweep_casadi as S
    p = np.tile(np.array([S.POINTS[k] for k in S.NAMES], float).ravel(), (len(rows), 1))
    assert set(swept) == set(S.COLUMNS)
    for name, column in zip(swept, rows.T):
        point, axis = S.COLUMNS[name]
        p[:, 3*S.NAMES.index(point) + axis] += column
    return p


def casadi_sweep(p, threads):
    import casadi as ca
    import sweep_casadi as S
    fPJ, fV, fO = S.functions()
    toes, spent = {}, dict(wall=0.0, cpu=0.0)
    for case, (steps, f1, g1) in CASES.items():
        xv, d, q, h = ca.SX.sym("xv", 8), ca.SX.sym("d", 4), ca.SX.sym("p", 21), 1.0/steps
        def at(x):
            for _ in range(3):
                x = x - fPJ(x, d, q)[1]
            v = fV(x, d, q)
            return ca.vertcat(x, v), fO(x, v, d, q)
        step = ca.Function("step", [xv, d, q], list(at(xv[:4] + h*xv[4:])))
        t = np.arange(steps + 1)/steps*2*np.pi
        laws = np.vstack([f1*np.sin(t), g1*np.sin(t), f1*2*np.pi*np.cos(t), g1*2*np.pi*np.cos(t)])
        motion = step.mapaccum("motion", steps + 1)
        x0, pars = ca.MX.sym("x0", 8), ca.MX.sym("p", 21)
        whole = ca.Function("whole", [pars], [motion(ca.DM.zeros(8), laws, ca.repmat(pars, 1, steps + 1))[1][0, :]])
        block = 1000
        mapped = whole.map(block, "thread", threads) if threads > 1 else whole.map(block)
        begun = now()
        found = [np.array(mapped(p[k:k + block].T)).reshape(block, steps + 1) for k in range(0, len(p), block)]
        spent = {key: spent[key] + more for key, more in since(begun).items()}
        toes[case] = np.degrees(np.concatenate(found))
    return spent, toes


def pinocchio_sweep(p):
    import pinocchio as pin
    import sweep_casadi as S
    place = lambda at, axis: pin.SE3(turned(axis), np.asarray(at, float))
    toes = {case: np.empty((len(p), steps + 1)) for case, (steps, _, _) in CASES.items()}
    begun = now()
    for n, row in enumerate(p):
        P = {k: row[3*i:3*i + 3] for i, k in enumerate(S.NAMES)}
        model = pin.Model()
        e, au = unit(P["A"] - P["B"]), unit(P["T"] - P["S"])
        hinge, top = place(P["A"], e), place(P["T"], au)
        arm = model.addJoint(0, pin.JointModelRZ(), hinge, "arm")
        ball = model.addJoint(0, pin.JointModelSpherical(), top, "top")
        strut = model.addJoint(ball, pin.JointModelPZ(), pin.SE3.Identity(), "strut")
        frame = lambda name, joint, base, at: model.addFrame(pin.Frame(name, joint, pin.SE3(np.eye(3), base.actInv(np.asarray(at, float))), pin.FrameType.OP_FRAME))
        on_arm, on_knuckle, rod = frame("E", arm, hinge, P["E"]), frame("K", strut, top, P["E"]), frame("D", strut, top, P["D"])
        spin = top.rotation.T @ unit(np.array(S.SPIN))
        data, world, rod2 = model.createData(), pin.LOCAL_WORLD_ALIGNED, (P["D"] - P["C"]) @ (P["D"] - P["C"])
        for case, (steps, f1, g1) in CASES.items():
            q, v, h = pin.neutral(model), np.zeros(model.nv), 1.0/steps
            for k in range(steps + 1):
                s, c = np.sin(2*np.pi*k*h), 2*np.pi*np.cos(2*np.pi*k*h)
                q = pin.integrate(model, q, v*(h if k else 0.0))
                q[5] = -f1*s
                inner = P["C"] + np.array([0.0, g1*s, 0.0])
                while True:
                    pin.computeJointJacobians(model, data, q)
                    pin.updateFramePlacements(model, data)
                    at = [data.oMf[i].translation for i in (on_arm, on_knuckle, rod)]
                    J = [pin.getFrameJacobian(model, data, i, world)[:3] for i in (on_arm, on_knuckle, rod)]
                    link = at[2] - inner
                    residual = np.append(at[0] - at[1], 0.5*(link @ link - rod2))
                    rows = np.vstack([J[0] - J[1], link @ J[2]])
                    if abs(residual).max() < 1e-8:
                        break
                    by = np.zeros(model.nv)
                    by[:4] = -np.linalg.solve(rows[:, :4], residual)
                    q = pin.integrate(model, q, by)
                v[4] = -f1*c
                v[:4] = np.linalg.solve(rows[:, :4], -rows[:, 4]*v[4] + np.array([0, 0, 0, link[1]*g1*c]))
                axis = data.oMi[strut].rotation @ spin
                toes[case][n, k] = np.degrees(np.arctan2(axis[0], axis[1]))
    return since(begun), toes


def unit(x):
    return x/np.linalg.norm(x)


def turned(axis):
    """a rotation that takes z to the axis"""
    other = np.eye(3)[np.argmin(abs(axis))]
    x = unit(np.cross(other, axis))
    return np.column_stack([x, np.cross(axis, x), axis])


def sweep(count, few):
    model = hardpoint.read(SWEEP)
    swept, rows = designs_of(model, count)
    p = points(swept, rows)
    found = {}
    for workers in (1, 2):
        for d in (False, True):
            begun = now()
            ours = {case: model.designs(rows, ["toe"], variables=swept, case=case, sensitivities=d, metrics=False, workers=workers) for case in CASES}
            spent = since(begun)
            found["hardpoint" + (", sensitivities" if d else "") + ", %d" % workers] = dict(designs=count, **spent)
            toes = {case: ours[case].values[:, 0].copy() for case in CASES}
            del ours
        begun = now()
        model.sweep(samples=count, workers=workers)
        found["hardpoint sweep, %d" % workers] = dict(designs=count, **since(begun))
        spent, theirs = casadi_sweep(p, workers)
        found["casadi, %d" % workers] = dict(designs=count, **spent, off=off(theirs, toes, count))
    spent, theirs = pinocchio_sweep(p[:few])
    found["pinocchio, 1"] = dict(designs=few, **spent, off=off(theirs, toes, few))
    return found


def off(theirs, toes, count):
    """the largest difference of toe, deg"""
    return max(float(abs(theirs[case][:count] - toes[case][:count]).max()) for case in CASES)


if __name__ == "__main__":
    repeat, count, few = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    print(json.dumps(dict(imports=imports(), calls=calls(repeat), sweep=sweep(count, few))))
