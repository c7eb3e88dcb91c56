//! Every shader is valid WGSL and agrees with the host about the structs they share. Needs no GPU.

use naga::valid::{Capabilities, ValidationFlags, Validator};
use umbrage::{HostLayout, Shader};

/// Those of the library, and of the renderer that is built on it.
fn shaders() -> impl Iterator<Item = Shader> {
    umbrage::shaders().into_iter().chain(umbrage_renderer::SHADERS.iter().copied())
}

fn parse(source: &str, name: &str) -> naga::Module {
    naga::front::wgsl::parse_str(source).unwrap_or_else(|e| panic!("{name}: {}", e.emit_to_string(source)))
}

#[test]
fn every_shader_is_valid() {
    for shader in shaders() {
        let source = shader.source();
        let module = parse(&source, shader.name);
        let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
        if let Err(e) = validator.validate(&module) {
            panic!("{}: {}", shader.name, e.emit_to_string(&source));
        }
    }
}

/// The first difference between the host's struct and the WGSL struct of the same name.
fn difference(host: &HostLayout, module: &naga::Module) -> Option<String> {
    let found = module.types.iter().find_map(|(_, t)| match &t.inner {
        naga::TypeInner::Struct { members, span } if t.name.as_deref() == Some(host.name) => Some((members, *span)),
        _ => None,
    });
    let Some((members, span)) = found else { return Some(format!("no struct {}", host.name)) };
    let wgsl: Vec<_> = members
        .iter()
        .map(|m| {
            let size = module.types[m.ty].inner.size(module.to_ctx()) as usize;
            (m.name.clone().unwrap_or_default(), m.offset as usize, size)
        })
        .collect();
    let on_host: Vec<_> = host.members.iter().map(|(n, o, s)| (n.to_string(), *o, *s)).collect();
    if wgsl != on_host {
        return Some(format!("{}: the host has {on_host:?}, the shader {wgsl:?}", host.name));
    }
    (host.size != span as usize)
        .then(|| format!("{}: {} bytes on the host, {span} in the shader", host.name, host.size))
}

#[test]
fn host_structs_match_the_shaders() {
    for shader in shaders() {
        let module = parse(&shader.source(), shader.name);
        for host in shader.layouts {
            assert_eq!(difference(host, &module), None, "{}", shader.name);
        }
    }
}

#[test]
fn a_wrong_offset_is_found() {
    let module = parse("struct S { a: vec3f, b: f32, }", "test");
    let right = HostLayout { name: "S", members: &[("a", 0, 12), ("b", 12, 4)], size: 16 };
    assert_eq!(difference(&right, &module), None);
    let wrong = HostLayout { name: "S", members: &[("a", 0, 12), ("b", 16, 4)], size: 20 };
    assert!(difference(&wrong, &module).is_some());
    assert!(difference(&HostLayout { name: "T", ..right }, &module).is_some());
}
