//! The device: adapters, limits, and errors as values.

use std::{
    sync::{Arc, Mutex, OnceLock, PoisonError},
    time::Duration,
};

use crate::{
    error::Error,
    gpu::{Kernel, MAX_WORKGROUPS, WORKGROUP, mutation::Mutation, parts, shader::Shader, workgroups},
    input::lattice::Width,
    platform,
};

/// The most items for an invocation of a software device. Such devices end loops after 65,535 steps,
/// counted over all loops of an invocation. A slot takes up to some dozens of steps, and a point, of
/// which there is one per eight slots, some hundreds.
const MAX_SOFTWARE_ITEMS: u32 = 1 << 10;

/// The bytes of device memory that are allocated at a time, for buffers that are not larger.
const MEMORY_BLOCK: u64 = 256 << 20;

/// Returns the most workgroups for `items` items on a software device.
fn software_workgroups(items: u32) -> u32 {
    let busy = 2 * std::thread::available_parallelism().map_or(2, |n| n.get() as u32);
    busy.max(items.div_ceil(WORKGROUP * MAX_SOFTWARE_ITEMS))
}

/// Which adapter to open. Browsers offer only the default.
///
/// # Examples
///
/// ```
/// use gdel::{AdapterChoice, Backend, Triangulator};
///
/// let triangulator = Triangulator::new().adapter(AdapterChoice::Index(0)).backend(Backend::Gpu);
/// match triangulator.delaunay2d(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]]) {
///     Ok(mesh) => assert_eq!(mesh.triangles.len(), 1),
///     // There is no GPU at all.
///     Err(error) => println!("{error}"),
/// }
/// ```
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum AdapterChoice {
    /// The adapter that the system recommends for speed.
    #[default]
    Default,
    /// The adapter at this index of [`adapters`](crate::adapters).
    Index(usize),
    /// The first adapter whose name contains this, ignoring case.
    Name(String),
}

/// A GPU, as [`adapters`](crate::adapters) lists it.
///
/// # Examples
///
/// ```
/// let hardware = gdel::adapters().into_iter().find(|adapter| !adapter.software);
/// if let Some(adapter) = hardware {
///     println!("{}: buffers of up to {} bytes", adapter.name, adapter.max_storage_buffer_bytes);
/// }
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct AdapterSummary {
    /// The name that the driver gives, for example `NVIDIA H200`. Browsers may leave it empty.
    pub name: String,
    /// `vulkan`, `metal`, `dx12` or `webgpu`.
    pub backend: String,
    /// The driver and its version; empty in browsers.
    pub driver: String,
    /// Whether it computes on the CPU: its results are correct, but it is slower than the CPU
    /// backend.
    pub software: bool,
    /// The largest buffer that a kernel can use, in bytes, which limits the size of the input: in 3D to one
    /// point per 136 bytes. Where a kernel can use 32 buffers, which native adapters usually allow, large
    /// arrays consist of four, and so many times as many points fit.
    pub max_storage_buffer_bytes: u64,
    /// Whether stages can be timed on the device.
    pub timestamps: bool,
}

impl AdapterSummary {
    fn new(info: wgpu::AdapterInfo, limits: &wgpu::Limits, features: wgpu::Features) -> Self {
        AdapterSummary {
            name: info.name,
            backend: info.backend.to_str().to_owned(),
            driver: [info.driver, info.driver_info].join(" ").trim().to_owned(),
            software: info.device_type == wgpu::DeviceType::Cpu,
            max_storage_buffer_bytes: limits.max_storage_buffer_binding_size.min(limits.max_buffer_size),
            timestamps: features.contains(wgpu::Features::TIMESTAMP_QUERY),
        }
    }

    fn of(adapter: &wgpu::Adapter) -> Self {
        AdapterSummary::new(adapter.get_info(), &adapter.limits(), adapter.features())
    }
}

/// Optional features: timestamps of stages, and, natively, 64-bit integers for faster exact arithmetic.
const FEATURES: wgpu::Features = wgpu::Features::TIMESTAMP_QUERY.union(wgpu::Features::SHADER_INT64);

/// Returns the adapters of this machine, in the order that [`AdapterChoice::Index`] counts.
pub async fn adapters() -> Vec<AdapterSummary> {
    enumerate(&instance()).await.iter().map(AdapterSummary::of).collect()
}

fn instance() -> wgpu::Instance {
    wgpu::Instance::new(wgpu::InstanceDescriptor {
        // Such as the compiler for Direct3D, which WGPU_DX12_COMPILER names.
        backend_options: wgpu::BackendOptions::default().with_env(),
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    })
}

async fn enumerate(instance: &wgpu::Instance) -> Vec<wgpu::Adapter> {
    instance.enumerate_adapters(wgpu::Backends::all()).await
}

/// A device and its queue.
#[derive(Debug, Clone)]
pub struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    adapter: AdapterSummary,
    /// Why the device was lost, once it was.
    lost: Arc<OnceLock<String>>,
    /// Kernels that are compiled once for the device.
    kernels: Arc<Mutex<Vec<KeptKernel>>>,
    /// Whether the device stands for one that may be wrong, and how.
    mutation: Option<Option<Mutation>>,
}

/// The name of a kernel, the width for which it is compiled, and the kernel.
type KeptKernel = (&'static str, Width, Kernel);

impl Gpu {
    /// Opens an adapter.
    ///
    /// # Errors
    ///
    /// Returns [`Error::NoAdapter`] when there is none or it gives no device,
    /// [`Error::AdapterNotFound`] when there is none of that index or name.
    pub async fn open(choice: &AdapterChoice) -> Result<Self, Error> {
        let instance = instance();
        Gpu::on(&choose(&instance, choice).await?).await
    }

    /// Opens an adapter that somebody has chosen.
    ///
    /// # Errors
    ///
    /// Returns [`Error::NoAdapter`] when it gives no device.
    pub async fn on(adapter: &wgpu::Adapter) -> Result<Self, Error> {
        let limits = adapter.limits();
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("gdel"),
            required_features: adapter.features() & FEATURES,
            required_limits: wgpu::Limits {
                max_buffer_size: limits.max_buffer_size,
                max_storage_buffer_binding_size: limits.max_storage_buffer_binding_size,
                ..parts::limits(&limits)
            },
            // The allocator returns blocks without buffers to the driver, and another block takes the driver
            // as long as a whole update. In few blocks of the largest size, some buffer is always left when
            // a mesh replaces another.
            memory_hints: wgpu::MemoryHints::Manual {
                suballocated_device_memory_block_size: MEMORY_BLOCK..MEMORY_BLOCK,
            },
            ..Default::default()
        };
        let (device, queue) =
            adapter.request_device(&descriptor).await.map_err(|e| Error::NoAdapter { reason: e.to_string() })?;
        let gpu = Gpu::from_device(device, queue);
        let lost = Arc::clone(&gpu.lost);
        gpu.device.set_device_lost_callback(move |reason, message| {
            // Only the first reason is kept.
            let _ = lost.set(if message.is_empty() { format!("{reason:?}") } else { message });
        });
        Ok(gpu)
    }

    /// Returns whether this is a clone of `other`. Devices of different instances may compare equal.
    pub(crate) fn is_same(&self, other: &Gpu) -> bool {
        Arc::ptr_eq(&self.lost, &other.lost)
    }

    /// Uses the caller's device. Its limits are taken as they are: the defaults of WebGPU are
    /// enough, larger buffers allow larger inputs. Its handlers for errors and loss are left alone,
    /// so that its loss comes out as [`Error::Gpu`].
    pub fn from_device(device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let adapter = AdapterSummary::new(device.adapter_info(), &device.limits(), device.features());
        Gpu { device, queue, adapter, lost: Arc::default(), kernels: Arc::default(), mutation: None }
    }

    /// Returns the device.
    pub fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// Returns the queue.
    pub fn queue(&self) -> &wgpu::Queue {
        &self.queue
    }

    /// Returns the kernel that is kept by this name, or keeps a new one.
    pub(crate) fn kept_kernel(&self, name: &'static str, width: Width, new: impl FnOnce() -> Kernel) -> Kernel {
        let mut kernels = self.kernels.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((.., kernel)) = kernels.iter().find(|&&(kept, of, _)| (kept, of) == (name, width)) {
            return kernel.clone();
        }
        let kernel = new();
        kernels.push((name, width, kernel.clone()));
        kernel
    }

    /// Returns the same device with a shader changed, or with none. All other kernels are compiled once for all devices
    /// that are made of one.
    pub fn mutated(&self, mutation: Option<Mutation>) -> Gpu {
        let mut gpu = self.clone();
        gpu.mutation = Some(mutation);
        gpu
    }

    /// Returns the kernel of a shader, if the device was made by [`Gpu::mutated`].
    pub(crate) fn mutated_kernel(&self, shader: &'static Shader, width: Width) -> Option<Kernel> {
        let mutation = self.mutation.as_ref()?;
        let new = || Kernel::new(self.device(), shader, width, None);
        Some(match mutation {
            Some(Mutation { kernel, edit }) if *kernel == shader.name() => new().edited(&**edit),
            _ => self.kept_kernel(shader.name(), width, new),
        })
    }

    /// Returns the adapter that the device runs on.
    pub fn adapter(&self) -> &AdapterSummary {
        &self.adapter
    }

    /// Returns the workgroups for `items` items, for a kernel that strides. On a software device, each
    /// workgroup takes time even if it has nothing to do, so there are only as many as keep the cores
    /// busy, as long as no invocation gets too many items.
    pub(crate) fn workgroups(&self, items: usize) -> u32 {
        let items = u32::try_from(items).unwrap_or(u32::MAX);
        let most = match self.adapter.software {
            true => software_workgroups(items),
            false => MAX_WORKGROUPS,
        };
        workgroups(items).min(most)
    }

    /// Returns the size of the largest storage buffer that this device can bind, in bytes.
    pub fn max_storage_bytes(&self) -> u64 {
        self.adapter.max_storage_buffer_bytes
    }

    /// Runs `body`, which creates resources or submits commands, and turns what the device reports
    /// for it into an error. In browsers the answer takes a round trip to the GPU process, so
    /// create many resources in one `body`.
    ///
    /// # Errors
    ///
    /// Returns [`Error::OutOfDeviceMemory`], [`Error::DeviceLost`], the errors of `body`, and
    /// [`Error::Gpu`] for unexpected failures.
    pub async fn with_error_scope<T>(
        &self,
        what: &'static str,
        body: impl FnOnce() -> Result<T, Error>,
    ) -> Result<T, Error> {
        let (result, report) = {
            let scope = ErrorScope::open(self, what);
            let result = body();
            // Closed here and not after the await, because it belongs to this thread.
            (result, scope.close())
        };
        report.await?;
        result
    }

    /// Returns the error for a result that no device returns that computes rightly.
    pub(crate) fn wrong(&self, test: &'static str) -> Error {
        Error::WrongResults { adapter: self.adapter.name.clone(), test }
    }

    /// Returns the error for an operation that failed: the loss of the device, if that is why.
    pub(crate) fn failure(&self, message: &str) -> Error {
        // Native backends report the loss only when the device is polled and has nothing left to do. An
        // error of this poll says nothing new.
        let wait = wgpu::PollType::Wait { submission_index: None, timeout: Some(Duration::from_secs(1)) };
        let _ = self.device.poll(wait);
        match self.lost.get() {
            Some(reason) => Error::DeviceLost { reason: reason.clone() },
            None => Error::Gpu { reason: message.to_owned() },
        }
    }
}

/// Collects what the device reports for the commands between its opening and its closing.
pub(crate) struct ErrorScope<'a> {
    gpu: &'a Gpu,
    what: &'static str,
    /// For validation, internal errors, and lack of memory.
    guards: [wgpu::ErrorScopeGuard; 3],
}

impl<'a> ErrorScope<'a> {
    /// Opens a scope around `what`.
    pub(crate) fn open(gpu: &'a Gpu, what: &'static str) -> Self {
        use wgpu::ErrorFilter::{Internal, OutOfMemory, Validation};
        let guards = [Validation, Internal, OutOfMemory].map(|filter| gpu.device.push_error_scope(filter));
        ErrorScope { gpu, what, guards }
    }

    /// Closes the scope. The report says what went wrong, as [`Gpu::with_error_scope`] does.
    pub(crate) fn close(self) -> platform::gpu::Report {
        let ErrorScope { gpu, what, guards: [a, b, c] } = self;
        let gpu = gpu.clone();
        // The scopes are a stack.
        let [c, b, a] = [c, b, a].map(wgpu::ErrorScopeGuard::pop);
        platform::gpu::report(async move {
            // A resource for which memory is lacking is also reported as invalid.
            let [a, b, c] = [a.await, b.await, c.await];
            if let Some(report) = c.or(a).or(b) {
                return Err(match report {
                    wgpu::Error::OutOfMemory { .. } => Error::OutOfDeviceMemory { label: what },
                    error => gpu.failure(&error.to_string()),
                });
            }
            match gpu.lost.get() {
                Some(reason) => Err(Error::DeviceLost { reason: reason.clone() }),
                None => Ok(()),
            }
        })
    }
}

async fn choose(instance: &wgpu::Instance, choice: &AdapterChoice) -> Result<wgpu::Adapter, Error> {
    let matching = |adapters: Vec<wgpu::Adapter>, wanted: String, matches: &dyn Fn(usize, &str) -> bool| {
        let names: Vec<String> = adapters.iter().map(|a| a.get_info().name).collect();
        match names.iter().enumerate().position(|(i, name)| matches(i, name)) {
            Some(i) => Ok(adapters[i].clone()),
            None => Err(Error::AdapterNotFound { wanted, available: names }),
        }
    };
    match choice {
        AdapterChoice::Default => instance
            .request_adapter(&wgpu::RequestAdapterOptions {
                power_preference: wgpu::PowerPreference::HighPerformance,
                ..Default::default()
            })
            .await
            .map_err(|e| Error::NoAdapter { reason: e.to_string() }),
        AdapterChoice::Index(index) => matching(enumerate(instance).await, index.to_string(), &|i, _| i == *index),
        AdapterChoice::Name(part) => {
            // Names are ASCII; tables of all letters would take 2 % of a WebAssembly module.
            let is_in =
                |name: &str| name.as_bytes().windows(part.len()).any(|n| n.eq_ignore_ascii_case(part.as_bytes()));
            matching(enumerate(instance).await, part.clone(), &|_, name| part.is_empty() || is_in(name))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangulation of 850,000 points by four workgroups was wrong: their loops ended early.
    #[test]
    fn no_invocation_of_a_software_device_gets_too_many_items() {
        for items in [0, 1, 100_000, 7_000_000, u32::MAX] {
            let invocations = u64::from(software_workgroups(items)) * u64::from(WORKGROUP);
            assert!(u64::from(items) <= invocations * u64::from(MAX_SOFTWARE_ITEMS), "{items}");
        }
    }
}
