"""Pinocchio: compiles peer_pinocchio.cpp against the headers in the wheel `pin` and Debian's libeigen3-dev, runs it and
checks its results. The closed loop's derivatives are not in the library: they are priced as central differences."""
import json
import os
import subprocess
import sys

import numpy as np
import workloads as W

here, tmp = os.path.dirname(os.path.abspath(__file__)), W.tmpdir()
source, program = os.path.join(here, "peer_pinocchio.cpp"), os.path.join(tmp, "peer_pinocchio")
if W.stale(program, source):
    wheel = next(os.path.join(p, "cmeel.prefix") for p in sys.path if os.path.isdir(os.path.join(p, "cmeel.prefix")))
    eigen = subprocess.check_output(["pkg-config", "--cflags", "eigen3"], text=True).split()
    subprocess.check_call(["g++", "-O3", "-march=native", "-std=c++17", "-w", "-DNDEBUG", "-DBOOST_MPL_LIMIT_LIST_SIZE=40",
                           "-DBOOST_FUSION_INVOKE_MAX_ARITY=12", "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS",
                           "-I" + wheel + "/include", source, "-o", program] + eigen)


def run(workload):
    out = subprocess.check_output([program, os.path.join(tmp, "floor_data.txt"), tmp] + workload.split("-"), text=True)
    return json.loads(out.strip().splitlines()[-1])


# Central differences: analyses per gradient.
ANALYSES = dict(W1s=12, W2s=48, W4s=48)
for name in W.asked(["W1", "W1s", "W2", "W2s", "W3-1", "W3-10", "W3-100", "W4", "W4s"]):
    base = name.rstrip("s")
    d = run(base)
    if name in ANALYSES:
        W.emit("pinocchio", name, us_per_step=d["us_per_step"]*ANALYSES[name],
               note="%d analyses by central differences: multiplied, not run" % ANALYSES[name])
        continue
    if name == "W4":
        W.emit("pinocchio", name, **d)
        continue
    result = np.fromfile(os.path.join(tmp, "pinocchio_" + name.replace("-", "_") + ".f64")).reshape(d["steps"], d["bodies"], 24)
    reference = W.w3_reference(int(name[3:]))[:d["steps"]] if name.startswith("W3") else W.reference(name)
    W.emit("pinocchio", name, us_per_step=d["us_per_step"], newton_iters_mean=d["newton_iters_mean"], **W.errors(result, reference))
