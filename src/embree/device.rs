//! The device: Embree's threads, its memory, and the place where it reports errors.

use std::ffi::{CStr, CString, c_char, c_void};
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicIsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use super::error::{EmbreeError, ErrorKind};
use super::raw;
use super::version::Version;

/// What scenes are made with. Cloning it is cheap and shares it.
#[derive(Clone, Debug)]
pub struct Device(Arc<Handle>);

#[derive(Debug)]
struct Handle {
    raw: raw::RTCDevice,
    reports: Box<Reports>,
    /// The widest packet that Embree traces as a whole.
    #[cfg(embree4)]
    packet_width: usize,
}

// SAFETY: Embree's devices may be used from any thread, and `Reports` guards itself.
unsafe impl Send for Handle {}
// SAFETY: as above.
unsafe impl Sync for Handle {}

/// What Embree tells us by callback.
#[derive(Debug, Default)]
struct Reports {
    /// The first error since the last look.
    error: Mutex<Option<(ErrorKind, String)>>,
    /// Bytes that Embree has allocated and not yet given back.
    memory: AtomicIsize,
}

impl Device {
    /// Makes a device that builds scenes with up to `threads` threads.
    ///
    /// The calling thread is one of them: with 1, Embree starts none. Tracing always happens in the
    /// thread that calls.
    ///
    /// # Errors
    /// [`EmbreeError::Library`] when Embree cannot run here, for example on an unsupported processor.
    pub fn new(threads: NonZeroUsize) -> Result<Self, EmbreeError> {
        let config: CString = CString::new(format!("threads={threads}")).unwrap_or_default();
        // SAFETY: the string is terminated and outlives the call.
        let raw = unsafe { raw::rtcNewDevice(config.as_ptr()) };
        if raw.is_null() {
            // SAFETY: without a device, Embree gives the error of this thread.
            let code = unsafe { raw::rtcGetDeviceError(raw) };
            return Err(EmbreeError::Library {
                doing: "start",
                kind: code.into(),
                message: format!("no device with {threads} threads"),
            });
        }
        let reports = Box::<Reports>::default();
        let user = (&raw const *reports).cast_mut().cast::<c_void>();
        // SAFETY: the device is alive; `reports` lives, at this address, until after the device is
        // released, and the callbacks only take shared references to it.
        unsafe {
            raw::rtcSetDeviceErrorFunction(raw, Some(on_error), user);
            raw::rtcSetDeviceMemoryMonitorFunction(raw, Some(on_memory), user);
        }
        let device = Self(Arc::new(Handle {
            raw,
            reports,
            #[cfg(embree4)]
            packet_width: native_packet_width(raw),
        }));
        device.check("watch its device")?;
        Ok(device)
    }

    /// The version of the library.
    pub fn version(&self) -> Version {
        // SAFETY: the device is alive as long as `self`.
        let value = |property| unsafe { raw::rtcGetDeviceProperty(self.0.raw, property) };
        let number = |property| u32::try_from(value(property)).unwrap_or_default();
        Version {
            major: number(raw::RTCDeviceProperty::VERSION_MAJOR),
            minor: number(raw::RTCDeviceProperty::VERSION_MINOR),
            patch: number(raw::RTCDeviceProperty::VERSION_PATCH),
        }
    }

    /// The bytes that Embree holds now for this device's scenes, without the shared buffers.
    pub fn memory(&self) -> usize {
        usize::try_from(self.0.reports.memory.load(Ordering::Relaxed)).unwrap_or_default()
    }

    /// The widest packet that Embree traces as a whole: 4, 8 or 16.
    #[cfg(embree4)]
    pub(super) fn packet_width(&self) -> usize {
        self.0.packet_width
    }

    /// Whether `other` is this device.
    pub(super) fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }

    pub(super) fn raw(&self) -> raw::RTCDevice {
        self.0.raw
    }

    /// Turns what Embree has reported since the last look into an error; `doing` ends the sentence
    /// "Embree could not …".
    pub(super) fn check(&self, doing: &'static str) -> Result<(), EmbreeError> {
        let mut error = self
            .0
            .reports
            .error
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        match error.take() {
            None => Ok(()),
            Some((kind, message)) => Err(EmbreeError::Library {
                doing,
                kind,
                message,
            }),
        }
    }
}

impl Drop for Handle {
    fn drop(&mut self) {
        // SAFETY: this is the one reference that `rtcNewDevice` gave; scenes hold the `Device`.
        unsafe { raw::rtcReleaseDevice(self.raw) }
    }
}

#[cfg(embree4)]
fn native_packet_width(device: raw::RTCDevice) -> usize {
    // SAFETY: the caller has just made the device.
    let supported = |property| unsafe { raw::rtcGetDeviceProperty(device, property) } != 0;
    if supported(raw::RTCDeviceProperty::NATIVE_RAY16_SUPPORTED) {
        16
    } else if supported(raw::RTCDeviceProperty::NATIVE_RAY8_SUPPORTED) {
        8
    } else {
        4
    }
}

/// Keeps the first error, which is the cause of those that follow it.
///
/// Embree 4 has one code more than `embree4-sys` declares, for graphics processors; a device of the
/// kind made here never reports it.
unsafe extern "C" fn on_error(user: *mut c_void, code: raw::RTCError, message: *const c_char) {
    // SAFETY: `user` is the `Reports` given with this function, which outlives the device.
    let reports = unsafe { &*user.cast::<Reports>() };
    let message = if message.is_null() {
        String::new()
    } else {
        // SAFETY: Embree passes a terminated string, alive during the call.
        unsafe { CStr::from_ptr(message) }
            .to_string_lossy()
            .into_owned()
    };
    reports
        .error
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
        .get_or_insert((code.into(), message));
}

/// Counts Embree's memory, and lets it have what it asks for.
unsafe extern "C" fn on_memory(user: *mut c_void, bytes: isize, _post: bool) -> bool {
    // SAFETY: `user` is the `Reports` given with this function, which outlives the device.
    let reports = unsafe { &*user.cast::<Reports>() };
    reports.memory.fetch_add(bytes, Ordering::Relaxed);
    true
}
