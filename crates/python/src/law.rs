//! [`Law`]: a law of attitude in Python, asked once per control tick for all runs that are flown side by side.
//!
//! Runs take turns on the thread that flies them, each on a stack of its own (the crate `generator`): one that asks its
//! law leaves the thread to the others, and when all of them wait, the function answers for all at once. A run that is
//! flown alone (the nominal one of bands and pages, a replay) is asked about alone.

use std::cell::RefCell;
use std::sync::{Arc, Mutex, OnceLock};

use generator::{Generator, Gn, is_generator};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use spindrift::campaign::Plan;
use spindrift::control::laws::{KnownBody, LawInput, LawKind, LawSettings, PhaseLaw};
use spindrift::ensemble::supervision::Crew;
use spindrift::loops::OwnLaw;
use spindrift::loops::callback::{NAME, is_law_of};
use spindrift::loops::estimate::Estimate;
use spindrift::sampling::SampleId;
use spindrift::workflow::{Quiet, Session, WorkflowError};

use crate::locked;

/// Parts that are flown side by side on a thread, one run of each at a time: the function answers for up to as many.
const SIDE_BY_SIDE: usize = 64;
/// Bytes of the stack of each: what the kernels take, several times.
const STACK: usize = 2 << 20;

/// Refuses a law for a plan whose phases do not name it.
///
/// # Errors
/// A plan without such a phase.
pub fn refuse_unnamed(plan: &Plan) -> Result<(), WorkflowError> {
    if plan.loop_spec().is_some_and(is_law_of) {
        return Ok(());
    }
    Err(WorkflowError::Input("control=: no phase has law = \"python\" in [[guidance]]".to_owned()))
}

/// Leaves the thread to the other runs until all of them wait.
#[expect(deprecated, reason = "what replaces it is in the hands of who has begun the run, far from the law")]
fn rest() {
    generator::yield_with(());
}

/// Calls of several runs: the numbers of one after those of another.
#[derive(Default)]
struct Calls {
    numbers: Vec<f64>,
    count: usize,
}

impl Calls {
    /// Adds the numbers of a call, in the order of `_law.py`.
    fn push(&mut self, sample: SampleId, period: f64, input: &LawInput<'_>, estimate: &Estimate) {
        let parts: [&[f64]; 10] = [
            &[sample.0 as f64, input.time, period],
            &input.q_ts,
            &input.omega_se_s,
            &input.omega_te_s,
            &input.momentum_s,
            &estimate.q_es,
            &estimate.r_co_e,
            &estimate.v_co_e,
            &estimate.gyro_bias_s,
            &estimate.wheel_rates,
        ];
        parts.into_iter().for_each(|part| self.numbers.extend_from_slice(part));
        for (sensor, reading) in input.readings.iter() {
            self.numbers.push(input.time - reading.time);
            self.numbers.extend_from_slice(&sensor.telemetry(reading.values)[..sensor.width()]);
        }
        self.count += 1;
    }
}

/// Runs of this thread that wait: their calls, and the torques of these in the same order.
#[derive(Default)]
struct Waiting {
    calls: Calls,
    torques: Vec<[f64; 3]>,
}

thread_local! {
    static WAITING: RefCell<Waiting> = RefCell::default();
}

/// A function of Python, and what it has raised.
pub struct Law {
    /// `_law.answered(function)`: from sensors and bytes of calls to bytes of torques.
    ask: Py<PyAny>,
    /// The sensors of the loop: names, and how many numbers each measures. Known from the first call on.
    sensors: OnceLock<Vec<(String, usize)>>,
    raised: Mutex<Option<PyErr>>,
}

impl Law {
    /// # Errors
    /// NumPy is not installed.
    pub fn new(py: Python<'_>, control: &Bound<'_, PyAny>) -> PyResult<Arc<Self>> {
        let ask = py.import("spindrift._law")?.getattr("answered")?.call1((control,))?;
        Ok(Arc::new(Law { ask: ask.unbind(), sensors: OnceLock::new(), raised: Mutex::new(None) }))
    }

    /// True if the function has raised an exception, after which runs have no law.
    pub fn has_raised(&self) -> bool {
        locked(&self.raised).is_some()
    }

    /// The exception raised by the function; taken once.
    pub fn raised(&self) -> Option<PyErr> {
        locked(&self.raised).take()
    }

    /// The law for a session.
    pub fn own(self: &Arc<Self>) -> OwnLaw {
        let law = self.clone();
        let make = move |settings: &LawSettings<'_>| LawOfRun { law: law.clone(), sample: settings.sample };
        OwnLaw::Phase(LawKind::new(NAME, &[], make).reading(true))
    }

    /// The result of `work` without Python's lock, in a session under `control`, if there is one.
    ///
    /// # Errors
    /// That of `work`, or what `control` has raised.
    pub fn flown<T: Send>(
        py: Python<'_>,
        control: Option<&Bound<'_, PyAny>>,
        work: impl FnOnce(Session<'_>) -> Result<T, WorkflowError> + Send,
    ) -> PyResult<T> {
        let law = control.map(|control| Law::new(py, control)).transpose()?;
        let own = law.as_ref().map(Law::own);
        let done = py.detach(|| work(Session { law: own.as_ref(), ..Session::new(&Quiet::default())? }));
        law.and_then(|law| law.raised()).map_or_else(|| done.map_err(crate::raised), Err)
    }

    /// The torques of `calls`; NaN once the function has raised an exception.
    fn torques(&self, calls: &Calls) -> Vec<[f64; 3]> {
        let nothing = vec![[f64::NAN; 3]; calls.count];
        if self.has_raised() {
            return nothing;
        }
        let bytes: Vec<u8> = calls.numbers.iter().flat_map(|number| number.to_ne_bytes()).collect();
        let found = Python::attach(|py| -> PyResult<Vec<[f64; 3]>> {
            let sensors = self.sensors.get().map_or(&[][..], Vec::as_slice);
            let answer = self.ask.bind(py).call1((sensors, PyBytes::new(py, &bytes)))?;
            let answer = answer.cast::<PyBytes>().map_err(PyErr::from)?;
            let numbers = answer.as_bytes().as_chunks::<8>().0.iter().map(|bytes| f64::from_ne_bytes(*bytes));
            let numbers: Vec<f64> = numbers.collect();
            Ok(numbers.as_chunks::<3>().0.to_vec())
        });
        match found {
            Ok(torques) if torques.len() == calls.count => torques,
            Ok(_) => nothing,
            Err(error) => {
                // Python's lock is free again: who has it may ask for this one
                locked(&self.raised).get_or_insert(error);
                nothing
            }
        }
    }
}

/// The law in a phase of a run.
#[derive(Clone)]
struct LawOfRun {
    law: Arc<Law>,
    sample: SampleId,
}

impl PhaseLaw for LawOfRun {
    fn torque(&mut self, _: &KnownBody, input: &LawInput<'_>, period: f64) -> [f64; 3] {
        let (law, Some(estimate)) = (&self.law, input.estimate) else { return [f64::NAN; 3] };
        law.sensors.get_or_init(|| {
            let sensors = input.readings.iter();
            sensors.map(|(sensor, _)| (sensor.name.to_string(), sensor.width())).collect()
        });
        let add = |calls: &mut Calls| calls.push(self.sample, period, input, estimate);
        if !is_generator() {
            let mut alone = Calls::default();
            add(&mut alone);
            return law.torques(&alone)[0];
        }
        let place = WAITING.with_borrow_mut(|waiting| {
            add(&mut waiting.calls);
            waiting.calls.count - 1
        });
        rest();
        WAITING.with_borrow(|waiting| waiting.torques[place])
    }
}

impl Crew for Law {
    fn work(&self, work: &(dyn Fn() + Sync)) {
        // the thread is known to Python from its first call to its last, not anew at each
        Python::attach(|py| py.detach(|| self.fly(work)));
    }
}

impl Law {
    /// Does `work` several times side by side, and answers all that wait at once.
    fn fly(&self, work: &(dyn Fn() + Sync)) {
        let begin = |_| Gn::<()>::new_opt(STACK / size_of::<usize>(), work);
        let mut runs: Vec<Generator<'_, (), ()>> = (0..SIDE_BY_SIDE).map(begin).collect();
        while !runs.is_empty() {
            runs.retain_mut(|run| {
                run.resume();
                !run.is_done()
            });
            let calls = WAITING.with_borrow_mut(|waiting| std::mem::take(&mut waiting.calls));
            if calls.count > 0 {
                let torques = self.torques(&calls);
                WAITING.with_borrow_mut(|waiting| waiting.torques = torques);
            }
        }
    }
}
