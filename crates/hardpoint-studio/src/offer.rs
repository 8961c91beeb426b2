//! Options of a study, with their values in the model text.

use hardpoint::model::{
    Dimension, Goal, Limit, LimitTarget, Model, OptimizationSettings, ToleranceSettings, VariableId,
};
use hardpoint::run::metrics;
use hardpoint::topology::Formulation;
use hardpoint_file::{ModelFile, Units};
use hardpoint_report::figures::{number, order_unit, variable_unit, with_unit};
use hardpoint_study::Motions;
use hardpoint_study::optimize::{self, Overrides, Selection};
use hardpoint_study::request::{named, variable};

use crate::EngineError;
use crate::protocol::{
    OptimizeOffer, OptimizeRequest, SearchGoal, SearchVariable, ToleranceChoice, ToleranceOffer,
};

/// Returns the options of an optimisation.
pub(crate) fn optimize(file: &ModelFile) -> Result<OptimizeOffer, EngineError> {
    let (model, units, settings) = (&file.model, file.units, file.model.optimization.as_ref());
    let OptimizationSettings { starts, iterations, .. } = OptimizationSettings::default();
    let values = values(file);
    let variable = |(k, v): (usize, &hardpoint::model::DesignVariable)| SearchVariable {
        name: v.name.clone(),
        unit: variable_unit(model, units, v),
        bounds: v.bounds.map(|b| b.map(|x| file.value_of(VariableId(k), x))),
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
        starts: settings.map_or(starts, |settings| settings.starts),
        iterations: settings.map_or(iterations, |settings| settings.iterations),
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
        LimitTarget::Margin => (Dimension::NUMBER, "margin to a singular position".into()),
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

/// Returns the request for an optimisation, and sets the requested bounds in the model.
pub(crate) fn requested(
    file: &mut ModelFile,
    request: &OptimizeRequest,
) -> Result<optimize::Request, hardpoint_study::RequestError> {
    let mut selection = Selection::default();
    for choice in &request.variables {
        let v = variable(&file.model, &choice.name)?;
        file.model.variables[v.0].bounds = Some(choice.bounds.map(|x| file.change_to(v, x)));
        selection.variables.push(v);
    }
    let goals = file.model.optimization.as_ref().map_or(&[][..], |settings| &settings.goals);
    for goal in &request.goals {
        let metric = named("metric", &goal.metric, file.model.metrics.iter().map(|m| m.name.as_str()))?;
        let unit = file.units.from_si(file.model.metric_dimension(&file.model.metrics[metric]), 1.0);
        selection.goals.push(Goal {
            name: goals
                .iter()
                .find(|goal| goal.metric == metric)
                .map_or(&goal.metric, |goal| &goal.name)
                .clone(),
            metric,
            target: goal.target.map(|x| x / unit),
            weight: goal.weight * unit,
        });
    }
    let overrides = Overrides {
        starts: Some(request.starts),
        iterations: Some(request.iterations),
        selection: Some(selection),
        // The page shows the designs of the model's own assembly.
        other_assemblies: Some(false),
        both_senses: Some(false),
        ..Overrides::default()
    };
    optimize::Request::of(&file.model, overrides)
}

/// Returns the options of a tolerance study.
pub(crate) fn tolerance(file: &ModelFile) -> Result<ToleranceOffer, EngineError> {
    let (model, units) = (&file.model, file.units);
    let settings = model.tolerance_settings();
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
