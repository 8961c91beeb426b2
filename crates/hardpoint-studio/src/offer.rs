//! Options of a study, with their values in the model text.

use hardpoint::model::{
    Dimension, Goal, Limit, LimitTarget, Model, OptimizationSettings, ToleranceSettings, VariableId,
};
use hardpoint::run::metrics;
use hardpoint::topology::Formulation;
use hardpoint_file::{ModelFile, Units};
use hardpoint_report::facts::variable_unit;
use hardpoint_report::figures::{number, order_unit, with_unit};
use hardpoint_study::Motions;

use crate::RequestError;
use crate::protocol::{
    DiagnosticMessage, OptimizeOffer, OptimizeRequest, SearchGoal, SearchVariable, ToleranceChoice,
    ToleranceOffer,
};

/// Default numbers of starts and iterations of an optimisation.
const STARTS: usize = 1;
const ITERATIONS: usize = 100;

/// Returns the options of an optimisation.
pub(crate) fn optimize(file: &ModelFile) -> Result<OptimizeOffer, RequestError> {
    let (model, units, settings) = (&file.model, file.units, file.model.optimization.as_ref());
    let values = values(file);
    let variable = |(k, v): (usize, &hardpoint::model::DesignVariable)| SearchVariable {
        name: v.name.clone(),
        unit: variable_unit(model, units, v),
        bounds: v
            .bounds
            .map(|b| b.map(|x| units.from_si(v.quantity, x + model.nominal_value(VariableId(k))))),
        chosen: settings.is_some_and(|settings| settings.variables.contains(&VariableId(k))),
    };
    let goal = |(k, metric): (usize, &hardpoint::model::Metric)| {
        let goal = settings.and_then(|settings| settings.goals.iter().find(|goal| goal.metric == k));
        let dimension = model.metric_dimension(metric);
        SearchGoal {
            metric: metric.name.clone(),
            unit: order_unit(units, dimension, 0),
            value: values.get(k).copied().flatten().map(|x| units.from_si(dimension, x)),
            weight: goal.map_or(1.0, |goal| goal.weight / units.from_si(dimension, 1.0)),
            target: goal.and_then(|goal| goal.target).map(|x| units.from_si(dimension, x)),
            curve: metric.take.target_points().is_some(),
            chosen: goal.is_some(),
        }
    };
    Ok(OptimizeOffer {
        variables: model.variables.iter().enumerate().map(variable).collect(),
        goals: model.metrics.iter().enumerate().map(goal).collect(),
        limits: settings.map_or(Vec::new(), |settings| {
            settings.limits.iter().map(|l| sentence(model, units, l)).collect()
        }),
        starts: settings.map_or(STARTS, |settings| settings.starts),
        iterations: settings.map_or(ITERATIONS, |settings| settings.iterations),
    })
}

/// Value of each metric, SI, in the first motion in which it is evaluated.
fn values(file: &ModelFile) -> Vec<Option<f64>> {
    let models = file.model.motions();
    let Ok(motions) = Motions::of(&models, Formulation::Relative) else { return Vec::new() };
    let mut found: Vec<Option<f64>> = vec![None; file.model.metrics.len()];
    for analysis in motions.analyses() {
        let solution = analysis.solve(hardpoint::Run::new().without_sensitivities());
        for (metric, value) in analysis.model().metrics.iter().zip(metrics(analysis.model(), &solution)) {
            let place = file.model.metrics.iter().position(|m| m.name == metric.name);
            if let Some(place) = place.filter(|place| found[*place].is_none()) {
                found[place] = value.value.filter(|x| x.is_finite());
            }
        }
    }
    found
}

fn sentence(model: &Model, units: Units, limit: &Limit) -> String {
    let (dimension, of) = match limit.of {
        LimitTarget::Metric(k) => (model.metric_dimension(&model.metrics[k]), model.metrics[k].name.clone()),
        LimitTarget::Coordinate(h, axis) => {
            (Dimension::LENGTH, format!("{}.{}", model.hardpoints[h.0].name, ["x", "y", "z"][axis]))
        }
        LimitTarget::Distance(a, b) => {
            let [a, b] = [a, b].map(|h| &model.hardpoints[h.0].name);
            (Dimension::LENGTH, format!("distance between {a} and {b}"))
        }
        LimitTarget::Length(j) => (Dimension::LENGTH, format!("length of {}", model.joints[j.0].name)),
    };
    let unit = order_unit(units, dimension, 0);
    let shown = |x: f64| with_unit(units.from_si(dimension, x), &unit);
    match (limit.least, limit.most) {
        (Some(least), Some(most)) if least == most => format!("`{of}`: {}", shown(least)),
        (Some(least), Some(most)) => {
            format!("`{of}`: {} to {}", number(units.from_si(dimension, least)), shown(most))
        }
        (Some(least), None) => format!("`{of}`: at least {}", shown(least)),
        (_, most) => format!("`{of}`: at most {}", most.map_or(String::new(), shown)),
    }
}

/// Returns the settings of the model text with those of the request in their place, and sets the requested bounds in
/// the model.
pub(crate) fn merged_settings(
    file: &mut ModelFile,
    request: &OptimizeRequest,
) -> Result<OptimizationSettings, RequestError> {
    let units = file.units;
    let unknown = |what: &str, name: &str| {
        vec![DiagnosticMessage::plain(
            "HP0704",
            format!("the model has no {what} `{name}`"),
            "open the pane again",
        )]
    };
    let mut settings = file.model.optimization.clone().unwrap_or(OptimizationSettings {
        variables: Vec::new(),
        goals: Vec::new(),
        limits: Vec::new(),
        margin: None,
        starts: STARTS,
        iterations: ITERATIONS,
    });
    settings.variables.clear();
    for choice in &request.variables {
        let v = file.model.variable(&choice.name).ok_or_else(|| unknown("design variable", &choice.name))?;
        let nominal = file.model.nominal_value(v);
        let variable = &mut file.model.variables[v.0];
        variable.bounds = Some(choice.bounds.map(|x| units.to_si(variable.quantity, x) - nominal));
        settings.variables.push(v);
    }
    let before = std::mem::take(&mut settings.goals);
    for goal in &request.goals {
        let metric = file.model.metrics.iter().position(|m| m.name == goal.metric);
        let metric = metric.ok_or_else(|| unknown("metric", &goal.metric))?;
        let dimension = file.model.metric_dimension(&file.model.metrics[metric]);
        let name = before.iter().find(|goal| goal.metric == metric).map_or(&goal.metric, |goal| &goal.name);
        settings.goals.push(Goal {
            name: name.clone(),
            metric,
            target: goal.target.map(|x| x / units.from_si(dimension, 1.0)),
            weight: goal.weight * units.from_si(dimension, 1.0),
        });
    }
    if settings.variables.is_empty() || settings.goals.is_empty() {
        let message = "an optimisation requires at least one variable and one goal".into();
        return Err(vec![DiagnosticMessage::plain(
            "HP0602",
            message,
            "select them in the pane, or add `[optimize.goals]` and `bounds`",
        )]);
    }
    settings.starts = request.starts.max(1);
    settings.iterations = request.iterations.max(1);
    Ok(settings)
}

/// Returns the options of a tolerance study.
pub(crate) fn tolerance(file: &ModelFile) -> Result<ToleranceOffer, RequestError> {
    let (model, units) = (&file.model, file.units);
    let settings = model.tolerancing.clone().or_else(|| ToleranceSettings::of_variables(model));
    let scattered = |t: &hardpoint::model::Tolerance| {
        let first = &model.variables[t.variables[0].0];
        ToleranceChoice {
            name: t.name.clone(),
            tolerance: units.from_si(first.quantity, t.reach),
            unit: variable_unit(model, units, first),
            distribution: t.scatter.name().into(),
        }
    };
    Ok(match settings {
        Some(settings) => ToleranceOffer {
            tolerances: settings.tolerances.iter().map(scattered).collect(),
            metrics: settings.metrics.iter().map(|k| model.metrics[*k].name.clone()).collect(),
            samples: settings.samples,
            seed: settings.seed,
        },
        None => ToleranceOffer {
            tolerances: Vec::new(),
            metrics: Vec::new(),
            samples: ToleranceSettings::SAMPLES,
            seed: ToleranceSettings::SEED,
        },
    })
}
