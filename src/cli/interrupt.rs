//! Ctrl-C.

use cohort::render::StopFlag;

use super::report::tell;

/// A flag that Ctrl-C raises, after `message` was told; a second Ctrl-C ends the program at once.
pub fn stop_on_interrupt(message: &'static str) -> Result<StopFlag, ctrlc::Error> {
    let stop = StopFlag::new();
    let raised = stop.clone();
    ctrlc::set_handler(move || {
        if raised.is_raised() {
            std::process::exit(130);
        }
        tell(message);
        raised.raise();
    })?;
    Ok(stop)
}
