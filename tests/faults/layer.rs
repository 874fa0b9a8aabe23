//! A Vulkan layer that makes a driver fail: built by the tests, loaded by Vulkan's own loader
//! between program and driver, so that the program holds nothing for it.
//!
//! `DPSM_FAULT="FUNCTION N KIND"`: from the N-th call of FUNCTION on (from 1) the device is `lost`,
//! its `memory` is used up, or that call alone `sleeps` for an hour.

use std::ffi::{CStr, c_char, c_void};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::SeqCst};

type Function = *const c_void;
type GetProcAddr = unsafe extern "system" fn(usize, *const c_char) -> Function;
type CreateInstance = unsafe extern "system" fn(*const Chained, usize, *mut usize) -> i32;
type CreateDevice = unsafe extern "system" fn(usize, *const Chained, usize, *mut usize) -> i32;

const OUT_OF_DEVICE_MEMORY: i32 = -2;
const INITIALIZATION_FAILED: i32 = -3;
const DEVICE_LOST: i32 = -4;

/// sType of the loader's links in what vkCreateInstance and vkCreateDevice are given.
const INSTANCE_LINKS: i32 = 47;
const DEVICE_LINKS: i32 = 48;

/// The beginning of any structure in a pNext chain; `function` and `link` are those of the loader's.
#[repr(C)]
struct Chained {
    kind: i32,
    next: *mut Chained,
    function: i32,
    link: *mut Link,
}

/// VkLayerInstanceLink and VkLayerDeviceLink.
#[repr(C)]
struct Link {
    next: *mut Link,
    get_instance: GetProcAddr,
    /// Of the physical device, or of the device.
    get_other: GetProcAddr,
}

static GET_INSTANCE: OnceLock<GetProcAddr> = OnceLock::new();
static GET_DEVICE: OnceLock<GetProcAddr> = OnceLock::new();
static INSTANCE: AtomicUsize = AtomicUsize::new(0);
static DEVICE: AtomicUsize = AtomicUsize::new(0);
static CALLS: AtomicUsize = AtomicUsize::new(0);
static STRUCK: AtomicBool = AtomicBool::new(false);

/// Takes this layer's link off the chain.
unsafe fn take_link(info: *const Chained, kind: i32) -> Option<*mut Link> {
    let mut at = unsafe { (*info).next };
    while !at.is_null() {
        let chained = unsafe { &mut *at };
        if chained.kind == kind && chained.function == 0 {
            let link = chained.link;
            chained.link = unsafe { (*link).next };
            return Some(link);
        }
        at = chained.next;
    }
    None
}

unsafe extern "system" fn create_instance(
    info: *const Chained,
    allocator: usize,
    instance: *mut usize,
) -> i32 {
    let Some(link) = (unsafe { take_link(info, INSTANCE_LINKS) }) else {
        return INITIALIZATION_FAILED;
    };
    let get = *GET_INSTANCE.get_or_init(|| unsafe { (*link).get_instance });
    let create = unsafe { get(0, c"vkCreateInstance".as_ptr()) };
    let create: CreateInstance = unsafe { std::mem::transmute(create) };
    let result = unsafe { create(info, allocator, instance) };
    INSTANCE.store(unsafe { *instance }, SeqCst);
    result
}

unsafe extern "system" fn create_device(
    physical: usize,
    info: *const Chained,
    allocator: usize,
    device: *mut usize,
) -> i32 {
    let Some(link) = (unsafe { take_link(info, DEVICE_LINKS) }) else {
        return INITIALIZATION_FAILED;
    };
    let link = unsafe { &*link };
    let instance = INSTANCE.load(SeqCst);
    let create = unsafe { (link.get_instance)(instance, c"vkCreateDevice".as_ptr()) };
    let create: CreateDevice = unsafe { std::mem::transmute(create) };
    let result = unsafe { create(physical, info, allocator, device) };
    GET_DEVICE.get_or_init(|| link.get_other);
    DEVICE.store(unsafe { *device }, SeqCst);
    result
}

/// What this call answers in place of the driver, if anything.
fn fault(name: &str) -> Option<i32> {
    let asked = std::env::var("DPSM_FAULT").ok()?;
    let [function, number, kind] = asked.split(' ').collect::<Vec<_>>()[..] else { return None };
    if function == name && CALLS.fetch_add(1, SeqCst) + 1 == number.parse().ok()? {
        STRUCK.store(true, SeqCst);
        if kind == "sleeps" {
            std::thread::sleep(std::time::Duration::from_secs(3600));
        }
    }
    let takes_memory = name == "vkAllocateMemory" || name.starts_with("vkCreate");
    match kind {
        _ if !STRUCK.load(SeqCst) => None,
        "lost" => Some(DEVICE_LOST),
        "memory" if takes_memory => Some(OUT_OF_DEVICE_MEMORY),
        _ => None,
    }
}

/// Functions that can fail so, with arguments of a register each.
macro_rules! faulty {
    ($($name:ident($($argument:ident)+))+) => {
        $(#[allow(non_snake_case)]
        unsafe extern "system" fn $name($($argument: usize),+) -> i32 {
            if let Some(code) = fault(stringify!($name)) {
                return code;
            }
            let name = concat!(stringify!($name), "\0");
            let get = GET_DEVICE.get().expect("a device was made");
            let next = unsafe { get(DEVICE.load(SeqCst), name.as_ptr().cast()) };
            let next: unsafe extern "system" fn($(faulty!(@usize $argument)),+) -> i32 =
                unsafe { std::mem::transmute(next) };
            unsafe { next($($argument),+) }
        })+

        fn intercepted(name: &str) -> Option<Function> {
            match name {
                "vkCreateInstance" => Some(create_instance as Function),
                "vkCreateDevice" => Some(create_device as Function),
                "vkGetDeviceProcAddr" => Some(vkGetDeviceProcAddr as Function),
                $(stringify!($name) => Some($name as Function),)+
                _ => None,
            }
        }
    };
    (@usize $argument:ident) => { usize };
}
faulty! {
    vkQueueSubmit(a b c d)
    vkWaitSemaphores(a b c)
    vkWaitSemaphoresKHR(a b c)
    vkWaitForFences(a b c d e)
    vkGetSemaphoreCounterValue(a b c)
    vkGetSemaphoreCounterValueKHR(a b c)
    vkQueueWaitIdle(a)
    vkDeviceWaitIdle(a)
    vkAllocateMemory(a b c d)
    vkCreateBuffer(a b c d)
    vkCreateImage(a b c d)
    vkCreateImageView(a b c d)
    vkCreateFramebuffer(a b c d)
    vkCreateRenderPass(a b c d)
    vkCreateShaderModule(a b c d)
    vkCreateComputePipelines(a b c d e f)
    vkCreateGraphicsPipelines(a b c d e f)
    vkCreateDescriptorPool(a b c d)
    vkCreateQueryPool(a b c d)
    vkCreateCommandPool(a b c d)
}

/// Called by the loader.
///
/// # Safety
/// `name` ends with 0.
#[unsafe(no_mangle)]
pub unsafe extern "system" fn vkGetInstanceProcAddr(
    instance: usize,
    name: *const c_char,
) -> Function {
    let known = unsafe { CStr::from_ptr(name) }.to_str().ok().and_then(intercepted);
    let next = || GET_INSTANCE.get().map_or(std::ptr::null(), |get| unsafe { get(instance, name) });
    known.unwrap_or_else(next)
}

/// Called by the loader.
///
/// # Safety
/// `name` ends with 0.
#[unsafe(no_mangle)]
pub unsafe extern "system" fn vkGetDeviceProcAddr(device: usize, name: *const c_char) -> Function {
    let known = unsafe { CStr::from_ptr(name) }.to_str().ok().and_then(intercepted);
    let next = || GET_DEVICE.get().map_or(std::ptr::null(), |get| unsafe { get(device, name) });
    known.unwrap_or_else(next)
}
