"""pylinkage with numba: planar, dyad by dyad in closed form, velocities and accelerations included. Its crank turns at constant
speed only and its results are points of joints, so W1 and W3 run with that motion over the same number of steps and are
checked against its closed form. Compilation is not timed."""
import time

import numpy as np
import workloads as W
from pylinkage import Crank, Ground, Linkage, RRPDyad, RRRDyad


def measured(linkage, steps, speed):
    """median CPU time of a run over fresh linkages, and the points"""
    times = []
    for _ in range(6):
        L, c = linkage()
        L.set_input_velocity(c, speed)
        L.compile()
        before = time.process_time()
        result = L.step_fast_with_kinematics(iterations=steps, dt=1)
        times.append(time.process_time() - before)
    return float(np.median(times[1:])), np.asarray(result[0])


def slider_crank(steps):
    J1, J2, J3 = (tuple(map(float, J)) for J in W.W1_P.reshape(3, 2))
    speed = np.pi/(steps-1)
    radius, rod = float(np.hypot(J2[0]-J1[0], J2[1]-J1[1])), float(np.hypot(J3[0]-J2[0], J3[1]-J2[1]))
    start = float(np.arctan2(J2[1]-J1[1], J2[0]-J1[0]))

    def linkage():
        pivot, left, right = Ground(*J1, name="J1"), Ground(0.0, J3[1], name="left"), Ground(1.0, J3[1], name="right")
        crank = Crank(anchor=pivot, radius=radius, angular_velocity=speed, initial_angle=start)
        slider = RRPDyad(revolute_anchor=crank, line_anchor1=left, line_anchor2=right, distance=rod, x=J3[0], y=J3[1], name="slider")
        return Linkage([pivot, left, right, crank, slider]), crank
    taken, points = measured(linkage, steps, speed)
    angle = start + speed*np.arange(1, steps+1)
    x = radius*np.cos(angle) + np.sqrt(rod**2 - (radius*np.sin(angle))**2)
    return taken, np.abs(points[:, -1, 0] - x).max()


def chain(loops, steps):
    speed, start = 0.005, np.pi/2 - 0.5

    def linkage():
        pivots = [Ground(float(i), 0.0, name="pivot%d" % i) for i in range(loops+1)]
        crank = Crank(anchor=pivots[0], radius=1.0, angular_velocity=speed, initial_angle=start, name="crank")
        bars = [crank]
        for i, pivot in enumerate(pivots[1:], 1):
            bars.append(RRRDyad(anchor1=bars[-1], anchor2=pivot, distance1=1.0, distance2=1.0,
                                x=float(i+np.cos(start)), y=float(np.sin(start)), name="bar%d" % i))
        return Linkage(pivots + bars), crank
    taken, points = measured(linkage, steps, speed)
    angle = start + speed*np.arange(1, steps+1)
    return taken, np.abs(points[:, -1, :2] - np.stack([loops + np.cos(angle), np.sin(angle)], 1)).max()


for name in W.asked(["W1", "W3-1", "W3-10", "W3-100", "W3-1000"]):
    steps = W.W1_STEPS if name == "W1" else W.W3_STEPS
    taken, error = slider_crank(steps) if name == "W1" else chain(int(name[3:]), steps)
    W.emit("pylinkage", name, us_per_step=taken/steps*1e6, err_pos=float(error), note="constant-speed crank, joint points only")
