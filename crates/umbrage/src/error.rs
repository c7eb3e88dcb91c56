//! What can go wrong, each with the remedy in its text.

/// An error of the GPU library. Its text is one line that says what to do.
#[derive(Clone, Debug, thiserror::Error, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// No adapter fits.
    #[error(
        "no usable graphics adapter{}; install a Vulkan driver (Debian, Ubuntu: apt-get install mesa-vulkan-drivers)",
        if .found.is_empty() { String::new() } else { format!(" ({found})") }
    )]
    NoAdapter {
        /// The adapters that are there, each with the reason why it can't be used.
        found: String,
    },
    /// The driver refused a device.
    #[error("the adapter {adapter} gives no device: {reason}; choose another one")]
    NoDevice {
        /// Adapter name.
        adapter: String,
        /// What the driver said.
        reason: String,
    },
    /// The device is gone: driver reset, unplugged, or destroyed by the host.
    #[error("the graphics device was lost ({0}); make a new one and build casters, receivers and techniques again")]
    DeviceLost(String),
    /// The driver rejected something that should have been right.
    #[error("the graphics driver reports: {0}")]
    Driver(String),
    /// Encoders were submitted in another order than they were recorded in. Whatever was kept from
    /// frame to frame is made anew.
    #[error(
        "frame {frame} of a recorder was submitted after frame {by}; submit encoders in the order in which they were \
         given to Recorder::begin"
    )]
    Order {
        /// The frame that came late, counted by its recorder from 1.
        frame: u64,
        /// A later one that came before it.
        by: u64,
    },
    /// Fragments were to be counted, and the device only tells whether there are any.
    #[error("this adapter counts no fragments, it only tells whether there are any; choose another one")]
    NotCounted,
    /// Name not in the registry, with the nearest one.
    #[error("unknown {what} `{name}`{}", suggestion(.nearest))]
    Unknown {
        /// Kind of thing: technique, parameter, adapter.
        what: &'static str,
        /// What was asked for.
        name: String,
        /// The nearest known name, or the list of them.
        nearest: Option<String>,
    },
    /// A parameter's value is out of its range or of the wrong type.
    #[error("parameter `{name}` of {technique}: `{value}` is not {expected}")]
    Setting {
        /// Technique id.
        technique: String,
        /// Parameter name.
        name: String,
        /// The value given.
        value: String,
        /// What is allowed.
        expected: String,
    },
    /// A technique can't do this light or lacks a feature.
    #[error("{technique}: not for {what}")]
    Unsupported {
        /// Technique id.
        technique: String,
        /// What it can't do.
        what: String,
    },
    /// A light can't shine.
    #[error("{0}")]
    Light(String),
    /// A camera sees nothing.
    #[error("{0}")]
    Camera(String),
    /// A handle that names nothing.
    #[error(
        "this handle names no {what} of these casters: it was removed, or is of other casters; keep the handle that adding it gave"
    )]
    Handle {
        /// What it would be the handle of: instance, mesh, material, texture.
        what: &'static str,
    },
    /// A size is 0 or over the adapter's limit.
    #[error("{what} of {size} is {}; the adapter allows 1 to {limit}", if *.size == 0 { "empty" } else { "too large" })]
    Size {
        /// What has the size.
        what: String,
        /// The size asked for.
        size: u64,
        /// The largest possible.
        limit: u64,
    },
    /// A buffer or texture that a host lends is not of the kind that it has to be.
    #[error("{0}")]
    Lent(String),
    /// Look-ups can't be a part of a host's shader as asked.
    #[error("{0}")]
    Inline(String),
    /// The scene can't be drawn.
    #[error("{0}")]
    Scene(String),
}

fn suggestion(nearest: &Option<String>) -> String {
    nearest.as_ref().map_or_else(String::new, |n| format!("; did you mean `{n}`?"))
}

/// The name among `known` nearest to `name`, where one is near enough to be meant: for "did you
/// mean".
pub fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<String> {
    known
        .map(|k| (strsim::damerau_levenshtein(&name.to_lowercase(), k), k))
        .filter(|(distance, k)| *distance <= 1 + k.len() / 3)
        .min()
        .map(|(_, k)| k.to_string())
}
