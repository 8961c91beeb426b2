//! Long work: the interpreter lock is released, progress is reported, Ctrl-C is handled.

use std::convert::Infallible;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

use hardpoint::Analysis;
use pyo3::prelude::*;

use crate::failure::Failure;

/// Interval in milliseconds between checks of signals and callbacks in Python.
static PATIENCE: AtomicU64 = AtomicU64::new(50);

/// Number of wake-ups of listeners since the module was loaded.
static WAKE_UPS: AtomicUsize = AtomicUsize::new(0);

fn patience() -> Duration {
    Duration::from_millis(PATIENCE.load(Ordering::Relaxed))
}

/// Sets the interval in ms at which long work checks for Ctrl-C and reports its progress; returns the previous one.
#[pyfunction]
pub(crate) fn set_patience(milliseconds: u64) -> u64 {
    PATIENCE.swap(milliseconds, Ordering::Relaxed)
}

/// Number of wake-ups of the thread that waits for long work: once at its end, and once per interval before.
#[pyfunction]
pub(crate) fn wake_ups() -> usize {
    WAKE_UPS.load(Ordering::Relaxed)
}

/// Progress of the work, and the request to stop it.
#[derive(Debug, Default)]
pub(crate) struct Watch {
    ended: Arc<AtomicBool>,
    done: AtomicUsize,
    total: AtomicUsize,
}

impl Watch {
    /// Returns whether to continue.
    pub fn more(&self) -> bool {
        !self.ended.load(Ordering::Relaxed)
    }

    /// Wraps an analysis so that it stops at its next output time on request.
    pub fn over<'m>(&self, analysis: &Analysis<'m>) -> Analysis<'m> {
        analysis.clone().ended_by(Arc::clone(&self.ended))
    }

    /// Returns whether to continue, for callbacks with a `ControlFlow`.
    pub fn flow(&self) -> ControlFlow<()> {
        if self.more() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    }

    /// Reports the progress: `done` of `total`.
    pub fn tell(&self, done: usize, total: usize) -> ControlFlow<()> {
        self.done.store(done, Ordering::Relaxed);
        self.total.store(total, Ordering::Relaxed);
        self.flow()
    }

    /// Checks Python for a signal, or an exception of the callback.
    fn ask(&self, py: Python<'_>, callback: Option<&Py<PyAny>>) -> PyResult<()> {
        py.check_signals()?;
        let (done, total) = (self.done.load(Ordering::Relaxed), self.total.load(Ordering::Relaxed));
        match callback.filter(|_| total > 0) {
            Some(callback) => callback.call1(py, (done, total)).map(drop),
            None => Ok(()),
        }
    }
}

/// Runs work on a thread of its own, without the interpreter lock, while this one listens. An exception that is raised
/// meanwhile stops the work and is returned.
pub(crate) fn patiently<T: Send>(
    py: Python<'_>,
    callback: Option<Py<PyAny>>,
    work: impl FnOnce(&Watch) -> T + Send,
) -> Result<T, Failure> {
    let watch = Watch::default();
    // Nothing is sent: the channel closes when the work ends for any reason, which wakes the listener at once.
    let (working, end) = mpsc::channel::<Infallible>();
    let (listened, callback) = (&watch, callback.as_ref());
    let (outcome, raised) = py.detach(move || {
        thread::scope(|scope| {
            let worker = scope.spawn(move || {
                let _working = working;
                work(listened)
            });
            let mut raised = None;
            loop {
                let woken = end.recv_timeout(patience());
                WAKE_UPS.fetch_add(1, Ordering::Relaxed);
                match woken {
                    Err(RecvTimeoutError::Disconnected) => break,
                    Err(RecvTimeoutError::Timeout) if raised.is_none() => {
                        raised = Python::attach(|py| listened.ask(py, callback)).err();
                        listened.ended.fetch_or(raised.is_some(), Ordering::Relaxed);
                    }
                    Err(RecvTimeoutError::Timeout) => {}
                    Ok(never) => match never {},
                }
            }
            (worker.join(), raised)
        })
    });
    if let Some(error) = raised {
        return Err(error.into());
    }
    let outcome = outcome.unwrap_or_else(|panic| std::panic::resume_unwind(panic));
    // The end is reported, too.
    watch.ask(py, callback)?;
    Ok(outcome)
}

/// Runs short work on this thread, without the interpreter lock; `Quick` is checked at every output time.
pub(crate) struct Quick {
    asked: Instant,
    raised: Option<PyErr>,
}

impl Quick {
    pub fn new() -> Self {
        Self { asked: Instant::now(), raised: None }
    }

    /// Returns whether to continue.
    pub fn go_on(&mut self) -> ControlFlow<()> {
        if self.raised.is_some() {
            return ControlFlow::Break(());
        }
        if self.asked.elapsed() < patience() {
            return ControlFlow::Continue(());
        }
        self.asked = Instant::now();
        match Python::attach(|py| py.check_signals()) {
            Ok(()) => ControlFlow::Continue(()),
            Err(error) => {
                self.raised = Some(error);
                ControlFlow::Break(())
            }
        }
    }

    /// Returns the raised exception, if any.
    pub fn end(self) -> Result<(), Failure> {
        self.raised.map_or(Ok(()), |error| Err(error.into()))
    }
}
