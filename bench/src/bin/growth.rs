//! Growth of cost: with design variables, with loops and bodies, and with both at once.
//!
//!     growth                                  measures all, writes the plots and the tables of docs/performance.md
//!     growth gradients                        gradients of some outputs, direct and adjoint: writes their table alone
//!     growth LOOPS VARIABLES STEPS [stored]   one chain: nanoseconds in all, and the peak memory of this process in bytes
//!
//! Every chain is measured by a process of its own, so that the peak is its own.

use std::error::Error;
use std::fmt::Write as _;
use std::hint::black_box;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

use hardpoint::model::{BodyId, Model, VariableId};
use hardpoint::motion::BodyState;
use hardpoint::run::GradientMethod;
use hardpoint::sensitivity::{Admissibility, BodySensitivity};
use hardpoint::{Analysis, Run, Sink, Solution};
use hardpoint_bench::workloads::{finished, timed};
use hardpoint_bench::{chain_with_variables, truss_with_variables, workload_model};
use plotters::prelude::*;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// Two curves over the same abscissae: streamed, stored.
type Curves = [Vec<(f64, f64)>; 2];

const VARIABLES: [usize; 9] = [0, 1, 2, 4, 8, 12, 16, 20, 24];
const LOOPS: [usize; 9] = [1, 3, 10, 30, 100, 300, 1000, 3000, 10_000];
/// Steps of a chain without variables.
const STEPS: usize = 200;
/// Loops and variables of the chains with both.
const BOTH: [[usize; 2]; 2] = [[1000, 100], [10_000, 1000]];
const NAMES: [&str; 2] = ["streamed", "stored"];
const COLOURS: [RGBColor; 2] = [RGBColor(0x1f, 0x77, 0xb4), RGBColor(0xd9, 0x5f, 0x02)];

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.as_slice() {
        [] => report(),
        [gradients] if gradients == "gradients" => write_part("gradients", &self::gradients()?),
        [loops, variables, steps, rest @ ..] => {
            let nanoseconds =
                time_chain(loops.parse()?, variables.parse()?, steps.parse()?, !rest.is_empty());
            println!("{nanoseconds} {}", peak_memory().map_or_else(String::new, |b| b.to_string()));
            Ok(())
        }
        _ => Err("usage: growth [LOOPS VARIABLES STEPS [stored]]".into()),
    }
}

// ---- measuring

/// Adds up one number of every result.
#[derive(Default)]
struct Sum(f64);

impl Sink for Sum {
    fn state(&mut self, _: usize, _: BodyId, state: &BodyState) {
        self.0 += state.a.x;
    }

    fn sensitivity(&mut self, _: usize, _: VariableId, _: BodyId, derivatives: &BodySensitivity) {
        self.0 += derivatives.da.x;
    }
}

fn stream(analysis: &Analysis<'_>) {
    let mut sum = Sum::default();
    let streamed = analysis.stream(Run::new(), &mut sum);
    assert!(streamed.stop.is_none(), "the mechanism stops: {:?}", streamed.stop);
    let follows = |a: &Admissibility| !matches!(a, Admissibility::CannotFollow { .. });
    assert!(streamed.admissibility.iter().all(follows), "a change that the mechanism cannot follow");
    assert!(black_box(sum.0).is_finite());
}

/// Nanoseconds that the model takes with all of its variables, streamed or stored.
fn time(model: &Model, stored: bool) -> u128 {
    let analysis = Analysis::new(model).expect("a mechanism that can be driven");
    let mut solution = Solution::default();
    // Where every variable of a large chain is followed, one run lasts long enough.
    let once = model.variables.len() * model.bodies.len() > 1_000_000;
    let median = timed(once, || {
        if stored { finished(&mut solution, |run| analysis.solve(run)) } else { stream(&analysis) }
    });
    median.as_nanos()
}

fn time_chain(loops: usize, variables: usize, steps: usize, stored: bool) -> u128 {
    let model = Model::from_draft(&chain_with_variables(loops, variables, steps)).expect("a valid chain");
    time(&model, stored)
}

/// Largest resident memory of this process so far, bytes; `None` where the system does not tell.
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix(" kB")?.parse().ok().map(|kilobytes: u64| 1024 * kilobytes)
}

/// Microseconds of a chain's whole run, and MB, measured by a process of its own.
fn chain_apart(loops: usize, variables: usize, steps: usize, stored: bool) -> Result<(f64, Option<f64>)> {
    eprintln!("{loops} loops, {variables} variables, {}", NAMES[usize::from(stored)]);
    let mut command = Command::new(std::env::current_exe()?);
    command.args([loops, variables, steps].map(|n| n.to_string())).args(stored.then_some("stored"));
    let output = command.output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into());
    }
    let text = String::from_utf8(output.stdout)?;
    let mut numbers = text.split_whitespace().map(str::parse::<f64>);
    let nanoseconds = numbers.next().ok_or("no time")??;
    Ok((1e-3 * nanoseconds, numbers.next().transpose()?.map(|bytes| 1e-6 * bytes)))
}

// ---- reporting

fn report() -> Result<()> {
    let cpu = std::fs::read_to_string("/proc/cpuinfo").ok();
    let cpu =
        cpu.as_deref().and_then(|c| c.lines().find_map(|l| l.strip_prefix("model name")?.split_once(": ")));
    let mut text = format!("CPU: {}.\n\n", cpu.map_or("unknown", |(_, name)| name));
    text += &variables()?;
    text += &loops()?;
    text += &both()?;
    write_part("growth", &text)?;
    write_part("gradients", &gradients()?)
}

/// Writes what is between two marks in `docs/performance.md`.
fn write_part(name: &str, text: &str) -> Result<()> {
    print!("{text}");
    let path = docs().join("performance.md");
    let page = std::fs::read_to_string(&path)?;
    let [begin, end] = ["begin", "end"].map(|mark| format!("<!-- {name}:{mark} -->"));
    let (before, rest) = page.split_once(&begin).ok_or_else(|| format!("no {name}:begin"))?;
    let (_, after) = rest.split_once(&end).ok_or_else(|| format!("no {name}:end"))?;
    Ok(write_whole(&path, &format!("{before}{begin}\n\n{text}{end}{after}"))?)
}

fn variables() -> Result<String> {
    let mut model = workload_model("w2");
    let all = std::mem::take(&mut model.variables);
    let mut curves = Curves::default();
    let mut rows = String::new();
    for v in VARIABLES {
        model.variables = all[..v].to_vec();
        let us = [false, true].map(|stored| 1e-3 * time(&model, stored) as f64 / model.times.len() as f64);
        curves.iter_mut().zip(us).for_each(|(curve, us)| curve.push((v as f64, us)));
        writeln!(rows, "| {v} | {:.3} | {:.3} |", us[0], us[1])?;
    }
    let [streamed, stored] = [0, 1].map(|k| slope(&curves[k]));
    plot("variables", "design variables of the MacPherson strut", "us per step", &curves, Log::None)?;
    Ok(format!(
        "![Time per step against design variables](images/growth_variables.svg)\n\n\
         One further design variable of the MacPherson strut W2 costs **{streamed:.3} us** per step streamed and \
         {stored:.3} us stored\n(slope of the line of least squares).\n\n\
         | design variables | us per step, streamed | stored |\n|---|---|---|\n{rows}\n"
    ))
}

fn loops() -> Result<String> {
    let (mut times, mut memory) = (Curves::default(), Curves::default());
    let mut rows = String::new();
    for n in LOOPS {
        write!(rows, "| {n} |")?;
        let mut peaks = String::new();
        for (k, stored) in [false, true].into_iter().enumerate() {
            let (us, peak) = chain_apart(n, 0, STEPS, stored)?;
            let each = us / (STEPS + 1) as f64 / n as f64;
            times[k].push((n as f64, each));
            memory[k].extend(peak.map(|mb| (n as f64, mb)));
            write!(rows, " {each:.3} |")?;
            write!(peaks, " {} |", peak.map_or_else(String::new, |mb| format!("{mb:.1}")))?;
        }
        writeln!(rows, "{peaks}")?;
    }
    plot("loops", "loops of the chain", "us per step and loop", &times, Log::X)?;
    let mut images = "![Time per step and loop against loops](images/growth_loops.svg)\n\n".to_owned();
    if !memory[0].is_empty() {
        plot("memory", "loops of the chain", "peak memory of the process, MB", &memory, Log::Both)?;
        images += "![Peak memory against loops](images/growth_memory.svg)\n\n";
    }
    Ok(format!(
        "{images}Chains, motion only, {} output times:\n\n\
         | loops | us per step and loop, streamed | stored | peak memory, MB, streamed | stored |\n\
         |---|---|---|---|---|\n{rows}\n",
        STEPS + 1
    ))
}

fn both() -> Result<String> {
    let mut rows = String::new();
    for [n, v] in BOTH {
        // Three steps go one by one, then eight at a time: the difference is one full eight.
        let (few, _) = chain_apart(n, v, 10, false)?;
        let (more, peak) = chain_apart(n, v, 18, false)?;
        let (motion, _) = chain_apart(n, 0, 18, false)?;
        let step = (more - few) / 8.0;
        let besides = few - 11.0 * step;
        let further = (step - motion / 19.0) / v as f64;
        let peak = peak.map_or_else(String::new, |mb| format!("{mb:.0}"));
        let (step, besides) = (1e-3 * step, 1e-6 * besides);
        writeln!(rows, "| {n} | {v} | {step:.1} | {further:.1} | {besides:.2} | {peak} |")?;
    }
    Ok(format!(
        "Chains with design variables, motion and all sensitivities of all bodies streamed. Every variable moves a pivot, and all \
         loops\nfrom there on follow: half of them on average. A step is an eighth of what 19 output times cost more than 11;\nwhat is left of these is laying out the variables before the first step and judging them after the last.\n\n\
         | loops | design variables | ms per step | us per step and variable, motion left out | s besides the steps | \
         peak memory, MB |\n|---|---|---|---|---|---|\n{rows}\n"
    ))
}

/// Gradients of a model's first outputs by that many variables: those of the model, over and over where there are more.
fn gradients() -> Result<String> {
    let (truss_nodes, steps) = (100, 40);
    let mut rows = String::new();
    for (name, outputs, variables) in [
        ("macpherson", 1, &[2, 7, 14, 224][..]),
        ("macpherson", 3, &[2, 7, 14]),
        ("macpherson", 13, &[14]),
        ("slider_crank", 1, &[2, 8, 128]),
        ("truss", 1, &[2, 20, 198]),
        ("truss", 2, &[2, 20, 198]),
    ] {
        let mut model = match name {
            "truss" => Model::from_draft(&truss_with_variables(truss_nodes, steps)).expect("a valid truss"),
            _ => hardpoint_bench::model(name),
        };
        let own = std::mem::take(&mut model.variables);
        for &v in variables {
            model.variables = own.iter().cycle().take(v).cloned().collect();
            let analysis = Analysis::new(&model).expect("a mechanism that can be driven");
            let asked: Vec<usize> = (0..outputs).collect();
            let us = |method: GradientMethod| {
                let time = timed(false, || {
                    let gradients = analysis.gradients(&[], &asked, method);
                    assert!(gradients.stop.is_none(), "the mechanism stops: {:?}", gradients.stop);
                    black_box(gradients.at(0, 0));
                });
                1e6 * time.as_secs_f64() / model.times.len() as f64
            };
            let [direct, adjoint] = [us(GradientMethod::Direct), us(GradientMethod::Adjoint)];
            let auto = analysis.gradients(&[], &asked, GradientMethod::Auto).method;
            let left_out = analysis.topology().redundant().count();
            let ratio = direct / adjoint;
            writeln!(
                rows,
                "| {name} | {left_out} | {outputs} | {v} | {direct:.2} | {adjoint:.2} | {ratio:.2} | {auto:?} |"
            )?;
        }
    }
    Ok(format!(
        "| mechanism | rows left out | outputs | variables | us per step, direct | adjoint | direct / adjoint | `Auto` takes |\n\
         |---|---|---|---|---|---|---|---|\n{rows}\n"
    ))
}

fn slope(curve: &[(f64, f64)]) -> f64 {
    let n = curve.len() as f64;
    let (x, y) = curve.iter().fold((0.0, 0.0), |(x, y), p| (x + p.0 / n, y + p.1 / n));
    let over = |f: &dyn Fn(&(f64, f64)) -> f64| curve.iter().map(f).sum::<f64>();
    over(&|p| (p.0 - x) * (p.1 - y)) / over(&|p| (p.0 - x).powi(2))
}

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs")
}

/// The whole file or none of it.
fn write_whole(path: &Path, text: &str) -> io::Result<()> {
    let part = path.with_extension("part");
    std::fs::write(&part, text)?;
    std::fs::rename(part, path)
}

/// Logarithmic axes.
enum Log {
    None,
    X,
    Both,
}

/// Writes `docs/images/growth_NAME.svg`.
fn plot(name: &str, x: &str, y: &str, curves: &Curves, log: Log) -> Result<()> {
    let mut svg = String::new();
    let points = || curves.iter().flatten();
    let (last, top) = points().fold((0.0, 0.0), |(a, b), p| (f64::max(a, p.0), f64::max(b, p.1)));
    {
        let area = SVGBackend::with_string(&mut svg, (720, 420)).into_drawing_area();
        area.fill(&WHITE)?;
        let mut chart = ChartBuilder::on(&area);
        chart.margin(16).x_label_area_size(44).y_label_area_size(64);
        macro_rules! draw {
            ($chart:expr) => {{
                let mut chart = $chart;
                let number = |v: &f64| format!("{}", (v * 1e6).round() / 1e6);
                let mut mesh = chart.configure_mesh();
                mesh.x_desc(x).y_desc(y).x_label_formatter(&number).y_label_formatter(&number);
                mesh.label_style(("sans-serif", 14))
                    .axis_desc_style(("sans-serif", 15))
                    .max_light_lines(0)
                    .draw()?;
                for ((curve, colour), name) in curves.iter().zip(COLOURS).zip(NAMES) {
                    let line = LineSeries::new(curve.iter().copied(), colour.stroke_width(2)).point_size(4);
                    chart.draw_series(line)?.label(name).legend(move |(x, y)| {
                        PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(2))
                    });
                }
                let mut labels = chart.configure_series_labels();
                labels.position(SeriesLabelPosition::UpperLeft).label_font(("sans-serif", 14));
                labels.background_style(WHITE).border_style(BLACK.mix(0.3)).draw()?;
            }};
        }
        match log {
            Log::None => draw!(chart.build_cartesian_2d(0.0..last, 0.0..1.1 * top)?),
            Log::X => draw!(chart.build_cartesian_2d((0.8..1.3 * last).log_scale(), 0.0..1.1 * top)?),
            Log::Both => {
                let low = points().map(|p| p.1).fold(f64::INFINITY, f64::min);
                let y = 10f64.powf(low.log10().floor())..10f64.powf(top.log10().ceil());
                draw!(chart.build_cartesian_2d((0.8..1.3 * last).log_scale(), y.log_scale())?)
            }
        }
        area.present()?;
    }
    Ok(write_whole(&docs().join(format!("images/growth_{name}.svg")), &svg)?)
}
