"""An optimisation with OpenMDAO: the strut's bump steer goes, the Ackermann error stays within its limit."""

from __future__ import annotations

from pathlib import Path

import openmdao.api as om

import hardpoint
from hardpoint.openmdao import MechanismComp

MODELS = Path(__file__).resolve().parents[2] / "models"


def main() -> float:
    strut = hardpoint.read(MODELS / "studies/strut_toe.toml")
    problem = om.Problem(reports=False)
    problem.model.add_subsystem("strut", MechanismComp(model=strut), promotes=["*"])
    for name, variable in strut.variables.items():
        if variable.bounds:
            problem.model.add_design_var(name, lower=variable.bounds[0], upper=variable.bounds[1])
    problem.model.add_objective("bump_toe_error", ref=0.01)
    problem.model.add_constraint("steer_ackermann", lower=0.1335)
    problem.driver = om.ScipyOptimizeDriver(optimizer="SLSQP", tol=1e-9, disp=False)
    problem.setup()
    before = strut.run(case="bump").metric("toe_error")
    problem.run_driver()

    design = {name: float(problem.get_val(name)[0]) for name in strut.variables}
    better = strut.run(design, case="bump")
    print(f"toe error {before:.4f} deg -> {better.metric('toe_error'):.4f} deg, with {design}")
    return better.metric("toe_error") / before


if __name__ == "__main__":
    main()
