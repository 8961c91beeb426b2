//! Long work: the interpreter stays free, progress is told, Ctrl-C is heard.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use pyo3::prelude::*;

use crate::failure::Failure;

/// So often Python is asked whether to go on.
const PATIENCE: Duration = Duration::from_millis(50);

/// How far work is, and whether it is still wanted.
#[derive(Debug, Default)]
pub(crate) struct Watch {
    ended: AtomicBool,
    done: AtomicUsize,
    total: AtomicUsize,
}

impl Watch {
    /// Whether it is still wanted.
    pub fn more(&self) -> bool {
        !self.ended.load(Ordering::Relaxed)
    }

    /// So much is done of so much.
    pub fn tell(&self, done: usize, total: usize) -> ControlFlow<()> {
        self.done.store(done, Ordering::Relaxed);
        self.total.store(total, Ordering::Relaxed);
        if self.more() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    }

    /// What Python has to say: a signal, or an exception of the callback.
    fn ask(&self, py: Python<'_>, callback: Option<&Py<PyAny>>) -> PyResult<()> {
        py.check_signals()?;
        let (done, total) = (self.done.load(Ordering::Relaxed), self.total.load(Ordering::Relaxed));
        match callback.filter(|_| total > 0) {
            Some(callback) => callback.call1(py, (done, total)).map(drop),
            None => Ok(()),
        }
    }
}

/// Does work on a thread of its own, with the interpreter free, while this one listens. What is raised meanwhile ends the work, and is
/// the outcome.
pub(crate) fn patiently<T: Send>(
    py: Python<'_>,
    callback: Option<Py<PyAny>>,
    work: impl FnOnce(&Watch) -> T + Send,
) -> Result<T, Failure> {
    let watch = Watch::default();
    let listener = thread::current();
    let (outcome, raised) = py.detach(|| {
        thread::scope(|scope| {
            let worker = scope.spawn(|| {
                let outcome = work(&watch);
                listener.unpark();
                outcome
            });
            let mut raised = None;
            let mut asked = Instant::now();
            while !worker.is_finished() {
                thread::park_timeout(PATIENCE);
                if raised.is_none() && asked.elapsed() >= PATIENCE {
                    asked = Instant::now();
                    raised = Python::attach(|py| watch.ask(py, callback.as_ref())).err();
                    watch.ended.fetch_or(raised.is_some(), Ordering::Relaxed);
                }
            }
            (worker.join(), raised)
        })
    });
    if let Some(error) = raised {
        return Err(error.into());
    }
    let outcome = outcome.unwrap_or_else(|panic| std::panic::resume_unwind(panic));
    // The end is told too.
    watch.ask(py, callback.as_ref())?;
    Ok(outcome)
}

/// Does short work on this thread, with the interpreter free; `Quick` is asked at every output time.
pub(crate) struct Quick {
    asked: Instant,
    raised: Option<PyErr>,
}

impl Quick {
    pub fn new() -> Self {
        Self { asked: Instant::now(), raised: None }
    }

    /// Whether to go on.
    pub fn go_on(&mut self) -> ControlFlow<()> {
        if self.asked.elapsed() < PATIENCE {
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

    /// What was raised.
    pub fn end(self) -> Result<(), Failure> {
        self.raised.map_or(Ok(()), |error| Err(error.into()))
    }
}
