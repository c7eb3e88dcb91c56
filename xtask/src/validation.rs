//! Every technique under Vulkan's validation layer, which knows what neither wgpu nor its shader
//! compiler checks, hazards between passes among it.

use crate::shell::{self, Profile};
use anyhow::{Context, Result, ensure};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{collections::BTreeMap, fs};

const FOLDER: &str = "target/validation";
const LAYER: &str = "VkLayer_khronos_validation";
const INSTALLED: [&str; 2] = ["/usr/share/vulkan/explicit_layer.d", "/usr/local/share/vulkan/explicit_layer.d"];

/// Everything to the standard output, as often as it comes; with synchronisation.
const SETTINGS: &str = "\
khronos_validation.debug_action = VK_DBG_LAYER_ACTION_LOG_MSG
khronos_validation.report_flags = error,warn
khronos_validation.log_filename = stdout
khronos_validation.enables = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT
khronos_validation.enable_message_limit = false
";

/// Scenes that have casters to be seen through, posed casters, and lights of several kinds.
const SCENES: [&str; 3] = ["primitives", "tentacles:0.3", "picket-fence:0.3"];

/// A message that is known: parts of its text, and why it comes.
struct Known {
    parts: &'static [&'static str],
    reason: &'static str,
}

const KNOWN: [Known; 3] = [
    Known {
        parts: &["InconsistentSpirv", "Invalid source language operand: 10"],
        reason: "the layer is older than SPIR-V's number for WGSL, which wgpu names as the source in debug builds",
    },
    Known {
        parts: &["SYNC-HAZARD-WRITE-AFTER-READ", "vkCmdEndRenderPass", "depth aspect during store with storeOp"],
        reason: "wgpu stores depth attachments that are read only, where VK_ATTACHMENT_STORE_OP_NONE would do; \
                 they are also read by the shader. What is stored is what was there",
    },
    Known {
        parts: &["-commandBuffer-02701", "VK_DYNAMIC_STATE_LINE_WIDTH state not set"],
        reason: "wgpu sets the stencil's reference, a dynamic state of all its pipelines (line width is not), only \
                 where a stencil operation reads it; `volume` counts without. The layer means that one",
    },
];

/// A message of the layer.
struct Message {
    /// The technique and scene, or the test, that it came from.
    by: String,
    text: String,
}

/// Which of the known messages this is.
fn known(text: &str) -> Option<usize> {
    KNOWN.iter().position(|known| known.parts.iter().all(|part| text.contains(part)))
}

/// Renders each scene with each technique, and runs the tests on the device, under the layer.
pub fn run() -> Result<()> {
    shell::build(Profile::Dev)?;
    fs::create_dir_all(FOLDER)?;
    let folder = fs::canonicalize(FOLDER)?;
    let Some(layer) = layer(&folder)? else {
        println!("nothing was validated: there is no {LAYER} (Debian, Ubuntu: vulkan-validationlayers)");
        return Ok(());
    };
    fs::write(folder.join("vk_layer_settings.txt"), SETTINGS)?;
    let list = shell::output(shell::tested_umbrage(&["list", "--json"])?)?;
    let list: Value = serde_json::from_str(&list).context("`umbrage list --json` printed no JSON")?;
    let ids = list["techniques"].as_array().context("`umbrage list --json` has no techniques")?;
    let mut seen = BTreeMap::new();
    let mut unknown = Vec::new();
    for id in ids.iter().filter_map(|t| t["id"].as_str()).filter(|id| !shell::is_reference(id)) {
        for scene in SCENES {
            for text in render(&folder, &layer, scene, id)? {
                match known(&text) {
                    Some(known) => *seen.entry((known, id.to_string())).or_insert(0) += 1,
                    None => unknown.push(Message { by: format!("{id}, {scene}"), text }),
                }
            }
        }
    }
    for message in tests(&folder, &layer)? {
        match known(&message.text) {
            Some(known) => *seen.entry((known, message.by)).or_insert(0) += 1,
            None => unknown.push(message),
        }
    }
    for ((known, id), count) in seen {
        println!("{id}: {count} times, since {}", KNOWN[known].reason);
    }
    let unknown: Vec<_> = unknown.iter().map(|message| format!("{}: {}", message.by, message.text)).collect();
    ensure!(unknown.is_empty(), "the validation layer reports:\n{}", unknown.join("\n"));
    println!("the validation layer reports no other message");
    Ok(())
}

/// What the layer prints while a technique renders a scene with all of its lights.
fn render(folder: &Path, layer: &Path, scene: &str, id: &str) -> Result<Vec<String>> {
    let picture = folder.join("picture.png");
    let line = ["render", scene, "--technique", id, "--size", "96x72", "-o"];
    let mut command = shell::tested_umbrage(&line)?;
    insert(command.arg(picture), folder, layer);
    let output = command.output().context("can't run `umbrage`")?;
    let (said, errors) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    ensure!(output.status.success(), "`umbrage {}` failed: {}", line.join(" "), errors.lines().last().unwrap_or("?"));
    ensure!(errors.contains("Insert instance layer \"VK_LAYER_KHRONOS_validation\""), "the layer was not loaded");
    Ok(said.lines().filter(|line| is_message(line)).map(String::from).collect())
}

/// Lets the loader put the layer in.
fn insert(command: &mut Command, folder: &Path, layer: &Path) {
    command.env("VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation").env("VK_LOADER_DEBUG", "layer");
    command.env("VK_LAYER_PATH", layer).env("VK_LAYER_SETTINGS_PATH", folder);
}

fn is_message(line: &str) -> bool {
    line.contains("(ERROR") || line.contains("(WARN")
}

/// What the layer prints while the tests on the device run, one after the other.
fn tests(folder: &Path, layer: &Path) -> Result<Vec<Message>> {
    let mut command = shell::cargo();
    command.args(["test", "--package", "umbrage", "--test", "gpu", "--", "--nocapture", "--test-threads=1"]);
    insert(&mut command, folder, layer);
    let output = command.output().context("can't run the tests")?;
    let (said, errors) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    ensure!(output.status.success(), "the tests fail under the layer: {}", errors.lines().last().unwrap_or("?"));
    ensure!(errors.contains("Insert instance layer \"VK_LAYER_KHRONOS_validation\""), "the layer was not loaded");
    let mut by = "the tests".to_string();
    let mut messages = Vec::new();
    for line in said.lines() {
        if let Some((test, _)) = line.strip_prefix("test ").and_then(|rest| rest.split_once(" ... ")) {
            by = test.to_string();
        }
        if is_message(line) {
            messages.push(Message { by: by.clone(), text: line.to_string() });
        }
    }
    Ok(messages)
}

/// The folder of the layer's description: where a host says, where systems have it, or of Debian's
/// package, unpacked here.
fn layer(folder: &Path) -> Result<Option<PathBuf>> {
    let named = std::env::var_os("VK_LAYER_PATH").map(PathBuf::from);
    let places = named.into_iter().chain(INSTALLED.map(PathBuf::from));
    if let Some(found) = places.into_iter().find(|place| place.join(format!("{LAYER}.json")).is_file()) {
        return Ok(Some(found));
    }
    let unpacked = folder.join("layer");
    if !unpacked.join(format!("{LAYER}.json")).is_file() && !unpack(folder, &unpacked)? {
        return Ok(None);
    }
    Ok(Some(unpacked))
}

/// Downloads the package and puts library and description side by side; false where that is not
/// how packages come.
fn unpack(folder: &Path, unpacked: &Path) -> Result<bool> {
    let mut download = Command::new("apt-get");
    download.args(["download", "vulkan-validationlayers"]).current_dir(folder);
    if shell::run(download).is_err() {
        return Ok(false);
    }
    let is_package = |path: &PathBuf| path.extension().is_some_and(|extension| extension == "deb");
    let package = fs::read_dir(folder)?.flatten().map(|entry| entry.path()).find(is_package);
    let mut extract = Command::new("dpkg-deb");
    extract.arg("-x").arg(package.context("apt-get has left no package")?).arg(folder.join("package"));
    shell::run(extract)?;
    fs::create_dir_all(unpacked)?;
    let libraries = folder.join("package/usr/lib");
    let library = fs::read_dir(&libraries)?.flatten().map(|entry| entry.path().join(format!("lib{LAYER}.so")));
    let library = library.into_iter().find(|path| path.is_file()).context("the package has no library")?;
    let text = fs::read_to_string(folder.join("package").join(&INSTALLED[0][1..]).join(format!("{LAYER}.json")))?;
    let name = format!("lib{LAYER}.so");
    fs::write(unpacked.join(format!("{LAYER}.json")), text.replace(&name, &library.to_string_lossy()))?;
    Ok(true)
}
