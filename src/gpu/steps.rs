//! Steps of work on the adapter: errors are caught, waits end, and a lost device is named.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Duration, Instant};

use super::{Device, GpuError};

/// How long a step may take where `DPSM_PATIENCE` says nothing: the largest maps take seconds on
/// lavapipe, the slowest of adapters.
const PATIENCE: Duration = Duration::from_secs(120);

/// How long the watchdog lets a wait end by itself, and how often it looks.
const GRACE: Duration = Duration::from_secs(1);
const TICK: Duration = Duration::from_millis(100);

/// The patience that the user asks for.
pub fn patience() -> Result<Duration, GpuError> {
    let Some(text) = std::env::var_os("DPSM_PATIENCE") else { return Ok(PATIENCE) };
    let text = text.to_string_lossy();
    let seconds = text.trim().parse().ok().and_then(|s| Duration::try_from_secs_f64(s).ok());
    let above_zero = seconds.filter(|seconds| !seconds.is_zero());
    above_zero.ok_or_else(|| GpuError::Patience(text.into_owned()))
}

/// What wgpu says beside its results, and what is being done.
#[derive(Debug, Default)]
pub struct Reports {
    /// Why the device is lost.
    lost: Mutex<Option<String>>,
    /// The first error outside any step.
    error: Mutex<Option<wgpu::Error>>,
    /// The step that runs, and since when.
    now: Mutex<Option<(String, Instant)>>,
}

/// The value, also where a thread has panicked over it: each is written in one piece.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Reports {
    /// Listens to a device. Nothing is left to wgpu's own handler, which panics.
    pub fn of(device: &wgpu::Device) -> Arc<Self> {
        let reports = Arc::new(Self::default());
        let heard = Arc::clone(&reports);
        device.set_device_lost_callback(move |reason, message| {
            let message = match message.as_str() {
                "" => format!("{reason:?}").to_lowercase(),
                _ => message.to_lowercase(),
            };
            heard.lose(message);
        });
        let heard = Arc::clone(&reports);
        device.on_uncaptured_error(Arc::new(move |error| {
            lock(&heard.error).get_or_insert(error);
        }));
        reports
    }

    /// The first reason is kept: others follow from it.
    fn lose(&self, message: String) {
        lock(&self.lost).get_or_insert(message);
    }
}

impl Device {
    /// Runs one step with wgpu's errors caught.
    pub fn step<R>(&self, step: &str, work: impl FnOnce() -> R) -> Result<R, GpuError> {
        let memory = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let internal = self.device.push_error_scope(wgpu::ErrorFilter::Internal);
        let validation = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let result = self.watched(step, work);
        let errors = [validation.pop(), internal.pop(), memory.pop()].map(pollster::block_on);
        // out of memory first: what else went wrong follows from it
        let error = errors.into_iter().rev().flatten().next();
        if error.is_some() {
            self.ask_why_lost();
        }
        self.check(step)?;
        error.map_or(Ok(result), |error| Err(error_of(step, &error)))
    }

    /// Submits one encoder's commands and waits for them.
    pub fn submit(&self, step: &str, encoder: wgpu::CommandEncoder) -> Result<(), GpuError> {
        let submit = || caught(|| self.queue.submit([encoder.finish()]));
        match self.step(step, submit)? {
            Ok(index) => self.wait(step, Some(index)),
            Err(panic) => {
                self.reports.lose(panic);
                self.check(step)
            }
        }
    }

    /// Reads a mappable buffer's first `bytes` bytes.
    pub fn read(&self, buffer: &wgpu::Buffer, bytes: u64) -> Result<Vec<u8>, GpuError> {
        let step = "reading back";
        let lost = |message: String| GpuError::Lost { step: step.into(), message };
        if bytes == 0 {
            return Ok(Vec::new());
        }
        let (sender, receiver) = std::sync::mpsc::channel();
        self.step(step, || {
            buffer.map_async(wgpu::MapMode::Read, ..bytes, move |result| {
                let _ = sender.send(result); // the receiver outlives the wait below
            });
        })?;
        self.wait(step, None)?;
        let mapped = receiver.try_recv().map_err(|error| lost(error.to_string()))?;
        mapped.map_err(|error| lost(error.to_string()))?;
        let range = buffer.get_mapped_range(..bytes).map_err(|error| lost(error.to_string()))?;
        let data = range.to_vec();
        drop(range);
        buffer.unmap();
        Ok(data)
    }

    /// Calls `on_hang` from a thread of its own when a step lasts much longer than the patience:
    /// waits end by themselves, but a driver can block in any call.
    pub fn watch(&self, on_hang: impl FnOnce(GpuError) + Send + 'static) {
        let (reports, patience) = (Arc::downgrade(&self.reports), self.patience);
        std::thread::spawn(move || {
            while let Some(reports) = Weak::upgrade(&reports) {
                let now = lock(&reports.now).clone();
                match now.filter(|(_, since)| since.elapsed() > patience + GRACE) {
                    Some((step, _)) => return on_hang(GpuError::Hung { step, patience }),
                    None => std::thread::sleep(TICK),
                }
            }
        });
    }

    /// Does something that the watchdog sees.
    fn watched<R>(&self, step: &str, work: impl FnOnce() -> R) -> R {
        let before = lock(&self.reports.now).replace((step.into(), Instant::now()));
        let result = work();
        *lock(&self.reports.now) = before;
        result
    }

    /// Waits for a submission, or for the last one.
    fn wait(&self, step: &str, index: Option<wgpu::SubmissionIndex>) -> Result<(), GpuError> {
        let timeout = Some(self.patience);
        let lost = |message| self.reports.lose(message);
        let until = wgpu::PollType::Wait { submission_index: index, timeout };
        match self.watched(step, || caught(|| self.device.poll(until))) {
            Ok(Err(wgpu::PollError::Timeout)) => {
                lost("it hangs".into());
                return Err(GpuError::Hung { step: step.into(), patience: self.patience });
            }
            // an index of no submission: the device was lost before it
            Ok(Err(error)) => {
                self.ask_why_lost();
                lost(error.to_string());
            }
            Err(panic) => lost(panic),
            Ok(Ok(_)) => {}
        }
        self.check(step)
    }

    /// Has wgpu say why a device is lost that was destroyed, of which it says nothing by itself.
    fn ask_why_lost(&self) {
        let _ = caught(|| self.device.poll(wgpu::PollType::Poll));
    }

    /// Fails where the device is lost, which wgpu's error scopes do not tell, or where something
    /// failed outside any step.
    fn check(&self, step: &str) -> Result<(), GpuError> {
        let step_named = || step.to_string();
        if let Some(message) = lock(&self.reports.lost).clone() {
            // wgpu gives a device up that has no memory for its own needs
            return Err(match message.contains("memory") {
                true => GpuError::OutOfMemory { step: step_named() },
                false => GpuError::Lost { step: step_named(), message },
            });
        }
        match lock(&self.reports.error).take() {
            Some(error) => Err(error_of(step, &error)),
            None => Ok(()),
        }
    }
}

impl Drop for Device {
    /// wgpu's queue waits without limit for its work when it is dropped, and panics where the device
    /// is lost: it is not dropped then.
    fn drop(&mut self) {
        if lock(&self.reports.lost).is_some() || std::thread::panicking() {
            std::mem::forget(self.queue.clone());
        }
    }
}

fn error_of(step: &str, error: &wgpu::Error) -> GpuError {
    let step = step.into();
    match error {
        wgpu::Error::OutOfMemory { .. } => GpuError::OutOfMemory { step },
        _ => GpuError::Rejected { step, message: error.to_string() },
    }
}

/// Calls wgpu where it is known to panic when the driver fails: in waits for a device that is lost in
/// them, and where memory ends for what it makes by itself. An error is what the panic says.
pub fn caught<R>(work: impl FnOnce() -> R) -> Result<R, String> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        text.or(panic.downcast_ref::<&str>().copied()).unwrap_or("unknown").to_lowercase()
    })
}
