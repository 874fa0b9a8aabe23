//! Times passes: timestamps at the pass's boundaries where the adapter has them and can be trusted
//! with them, else the clock around a submission that is waited for.

use std::time::{Duration, Instant};

use super::{Device, GpuError};

/// Where a pass writes its timestamps; `None` without the feature.
pub type Stamps<'a> = Option<&'a wgpu::QuerySet>;

/// Which ends of what is timed a pass is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ends {
    /// It begins with this pass.
    pub first: bool,
    /// It ends with this pass.
    pub last: bool,
}

/// One pass is all that is timed.
pub const ALONE: Ends = Ends { first: true, last: true };

/// A render pass's timestamp writes.
pub fn render_writes(
    stamps: Stamps<'_>,
    ends: Ends,
) -> Option<wgpu::RenderPassTimestampWrites<'_>> {
    let query_set = stamps.filter(|_| ends.first || ends.last)?;
    Some(wgpu::RenderPassTimestampWrites {
        query_set,
        beginning_of_pass_write_index: ends.first.then_some(0),
        end_of_pass_write_index: ends.last.then_some(1),
    })
}

/// A compute pass's timestamp writes.
pub fn compute_writes(
    stamps: Stamps<'_>,
    ends: Ends,
) -> Option<wgpu::ComputePassTimestampWrites<'_>> {
    let query_set = stamps.filter(|_| ends.first || ends.last)?;
    Some(wgpu::ComputePassTimestampWrites {
        query_set,
        beginning_of_pass_write_index: ends.first.then_some(0),
        end_of_pass_write_index: ends.last.then_some(1),
    })
}

impl Device {
    /// Runs passes alone and gives their time, from the first one's timestamp to the last one's;
    /// negative deltas give `None`. By the clock around the submission where there are no
    /// timestamps, and on software adapters: llvmpipe does a compute pass at once, but stamps it
    /// when it next draws, and so leaves out the sorting of triangles.
    pub fn time(
        &self,
        name: &str,
        record: impl Fn(&mut wgpu::CommandEncoder, Stamps<'_>),
    ) -> Result<Option<Duration>, GpuError> {
        let stamps = self.device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        if !stamps || self.info.device_type == wgpu::DeviceType::Cpu {
            let encoder = self.encode(name, |encoder| record(encoder, None))?;
            let start = Instant::now();
            self.submit(name, encoder)?;
            return Ok(Some(start.elapsed()));
        }
        let bytes = 2 * u64::from(wgpu::QUERY_SIZE);
        let usage = wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC;
        let resolved = self.buffer("timestamps", bytes, usage)?;
        let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        let back = self.buffer("timestamps read back", bytes, usage)?;
        let stamps = self.step(name, || {
            self.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("timestamps"),
                ty: wgpu::QueryType::Timestamp,
                count: 2,
            })
        })?;
        let encoder = self.encode(name, |encoder| {
            record(encoder, Some(&stamps));
            encoder.resolve_query_set(&stamps, 0..2, &resolved, 0);
            encoder.copy_buffer_to_buffer(&resolved, 0, &back, 0, bytes);
        })?;
        self.submit(name, encoder)?;
        let ticks: Vec<u64> = bytemuck::pod_collect_to_vec(&self.read(&back, bytes)?);
        let period = f64::from(self.queue.get_timestamp_period());
        let delta = ticks[1].checked_sub(ticks[0]);
        Ok(delta.map(|ticks| Duration::from_nanos((ticks as f64 * period) as u64)))
    }

    /// As `time`, after one run whose time is thrown away: the first one compiles.
    pub fn time_warm(
        &self,
        name: &str,
        record: impl Fn(&mut wgpu::CommandEncoder, Stamps<'_>),
    ) -> Result<(String, Duration), GpuError> {
        self.time(name, &record)?;
        let duration = self.time(name, &record)?.unwrap_or_default();
        Ok((name.to_string(), duration))
    }

    /// Records commands with wgpu's errors caught.
    pub fn encode(
        &self,
        step: &str,
        record: impl FnOnce(&mut wgpu::CommandEncoder),
    ) -> Result<wgpu::CommandEncoder, GpuError> {
        self.step(step, || {
            let mut encoder = self.device.create_command_encoder(&Default::default());
            record(&mut encoder);
            encoder
        })
    }
}

/// What is timed in turn: a name and what to record.
pub type Timed<'a> = (&'a str, &'a dyn Fn(&mut wgpu::CommandEncoder, Stamps<'_>));

impl Device {
    /// Times of each variant, `runs` of them after `warm_up` that are thrown away, as the first one
    /// compiles; the variants take turns, so that all meet the same load.
    pub fn time_in_turn(
        &self,
        variants: &[Timed<'_>],
        warm_up: u32,
        runs: u32,
    ) -> Result<Vec<Vec<Duration>>, GpuError> {
        let mut times = vec![Vec::new(); variants.len()];
        for run in 0..warm_up + runs {
            for ((name, record), times) in variants.iter().zip(&mut times) {
                let time = self.time(name, record)?;
                if run >= warm_up {
                    times.extend(time);
                }
            }
        }
        Ok(times)
    }
}

/// Least, lower quartile, median and upper quartile in seconds; 0 of none.
pub fn quartiles(times: &[Duration]) -> [f64; 4] {
    let mut times = times.to_vec();
    times.sort();
    let at = |quarter: usize| {
        let place = times.len().saturating_sub(1) * quarter / 4;
        times.get(place).map_or(0.0, Duration::as_secs_f64)
    };
    [0, 1, 2, 3].map(at)
}
