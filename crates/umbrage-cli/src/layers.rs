//! What the Vulkan loader brings along that prints to users' terminals.

/// Set, it keeps Mesa's layer that chooses among devices out of the process.
#[cfg(target_os = "linux")]
const OFF: &str = "NODEVICE_SELECT";

/// That layer asks a desktop which device it is on. Where there is none, it prints `error:
/// XDG_RUNTIME_DIR is invalid or not set in the environment.`, which is true and of no consequence.
/// Variables are for a process to find, not to set: the command starts itself again with the layer
/// off. Whoever uses the layer to choose a device keeps it.
#[cfg(target_os = "linux")]
pub fn without_device_chooser() {
    use std::os::unix::process::CommandExt;
    let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    if ["XDG_RUNTIME_DIR", "MESA_VK_DEVICE_SELECT", "DRI_PRIME", OFF].into_iter().any(is_set) {
        return;
    }
    let mut line = std::env::args_os();
    if let (Ok(program), Some(name)) = (std::env::current_exe(), line.next()) {
        // This returns only where it failed; then the command continues as it is.
        let _ = std::process::Command::new(program).arg0(name).args(line).env(OFF, "1").exec();
    }
}

/// Only Linux has that layer.
#[cfg(not(target_os = "linux"))]
pub fn without_device_chooser() {}
