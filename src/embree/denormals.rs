//! Flushing denormal numbers to zero, as Embree asks of every thread that traces rays.

use std::marker::PhantomData;

/// While this lives, the thread that made it computes with denormal numbers flushed to zero.
///
/// It belongs to that thread and cannot leave it.
#[must_use = "denormals are flushed only while this is alive"]
#[derive(Debug)]
pub struct DenormalsFlushed {
    #[cfg(target_arch = "x86_64")]
    saved: u32,
    stays_in_its_thread: PhantomData<*const ()>,
}

/// Sets the processor's FTZ and DAZ bits (results and operands that are denormal become zero) for
/// the calling thread until the guard is dropped.
///
/// Embree asks for it: a denormal slows an operation down a hundredfold, and rays produce them.
/// It does nothing on processors other than x86-64.
pub fn flush_denormals_to_zero() -> DenormalsFlushed {
    #[cfg(target_arch = "x86_64")]
    {
        const FLUSH_TO_ZERO: u32 = 1 << 15;
        const DENORMALS_ARE_ZERO: u32 = 1 << 6;
        let saved = x86::control_register();
        x86::set_control_register(saved | FLUSH_TO_ZERO | DENORMALS_ARE_ZERO);
        DenormalsFlushed {
            saved,
            stays_in_its_thread: PhantomData,
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    DenormalsFlushed {
        stays_in_its_thread: PhantomData,
    }
}

#[cfg(target_arch = "x86_64")]
impl Drop for DenormalsFlushed {
    fn drop(&mut self) {
        x86::set_control_register(self.saved);
    }
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use std::arch::asm;

    /// Reads MXCSR.
    pub fn control_register() -> u32 {
        let mut value = 0_u32;
        // SAFETY: the instruction writes the four bytes of `value` and nothing else.
        unsafe { asm!("stmxcsr [{}]", in(reg) &raw mut value, options(nostack, preserves_flags)) }
        value
    }

    /// Writes MXCSR.
    pub fn set_control_register(value: u32) {
        // SAFETY: the instruction reads the four bytes of `value`, which differ from the register
        // only in how denormals are treated: no exception is unmasked, rounding stays. The compiler
        // may therefore fold an operation on denormals differently than the processor would compute
        // it, and nothing in this program depends on the value of a denormal.
        unsafe { asm!("ldmxcsr [{}]", in(reg) &raw const value, options(nostack, preserves_flags)) }
    }
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use std::hint::black_box;

    use super::*;

    #[test]
    fn denormal_results_and_operands_are_zero_only_while_the_guard_lives() {
        let smallest_normal = black_box(f32::MIN_POSITIVE);
        let denormal = black_box(f32::from_bits(1 << 20));
        let result = || black_box(smallest_normal) * black_box(0.5);
        let operand = || black_box(denormal) * black_box(1024.0);
        assert!(result() > 0.0 && operand() > 0.0);
        let guard = flush_denormals_to_zero();
        let flushed = [result(), operand()];
        drop(guard);
        assert_eq!(flushed, [0.0; 2]);
        assert!(result() > 0.0 && operand() > 0.0);
    }
}
