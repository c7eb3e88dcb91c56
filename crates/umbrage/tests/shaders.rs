//! Every shader is valid WGSL and agrees with the host about the structs they share. Needs no GPU.

use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::collections::BTreeSet;
use umbrage::{HostConstant, HostLayout, Shader, Shared, shared};

/// Those of the library, and of the renderer that is built on it.
fn shaders() -> impl Iterator<Item = Shader> {
    umbrage::shaders().into_iter().chain(umbrage_renderer::SHADERS.iter().copied())
}

fn parse(source: &str, name: &str) -> naga::Module {
    naga::front::wgsl::parse_str(source).unwrap_or_else(|e| panic!("{name}: {}", e.emit_to_string(source)))
}

fn text(shader: &Shader) -> String {
    shader.text().unwrap_or_else(|e| panic!("{}: {e}", shader.name))
}

#[test]
fn every_shader_is_valid() {
    for shader in shaders() {
        let source = text(&shader);
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

/// The value of a constant, the default of an override, or the size of a struct.
fn value(name: &str, module: &naga::Module) -> Option<f64> {
    let constants = module.constants.iter().filter(|(_, c)| c.name.as_deref() == Some(name)).map(|(_, c)| c.init);
    let overrides = module.overrides.iter().filter(|(_, o)| o.name.as_deref() == Some(name));
    let number = constants.chain(overrides.filter_map(|(_, o)| o.init)).next();
    if let Some(number) = number {
        return literal(&module.global_expressions[number]);
    }
    module.types.iter().find_map(|(_, t)| match t.inner {
        naga::TypeInner::Struct { span, .. } if t.name.as_deref() == Some(name) => Some(f64::from(span)),
        _ => None,
    })
}

fn literal(expression: &naga::Expression) -> Option<f64> {
    match *expression {
        naga::Expression::Literal(naga::Literal::F32(x)) => Some(f64::from(x)),
        naga::Expression::Literal(naga::Literal::U32(x)) => Some(f64::from(x)),
        naga::Expression::Literal(naga::Literal::I32(x)) => Some(f64::from(x)),
        naga::Expression::Literal(naga::Literal::Bool(x)) => Some(f64::from(u8::from(x))),
        naga::Expression::Literal(naga::Literal::AbstractInt(x)) => Some(x as f64),
        naga::Expression::Literal(naga::Literal::AbstractFloat(x)) => Some(x),
        _ => None,
    }
}

/// What is wrong with the host's idea of a shader.
fn disagreements(layouts: &[HostLayout], constants: &[HostConstant], module: &naga::Module) -> Vec<String> {
    let structs = layouts.iter().filter_map(|host| difference(host, module));
    let numbers = constants.iter().filter_map(|(name, on_host)| {
        let found = value(name, module);
        (found != Some(*on_host)).then(|| format!("{name} is {on_host} on the host, {found:?} in the shader"))
    });
    structs.chain(numbers).collect()
}

#[test]
fn host_structs_and_constants_match_the_shaders() {
    let mut compared = BTreeSet::new();
    for shader in shaders() {
        let module = parse(&text(&shader), shader.name);
        let needs = shader.needs().expect("the needs of a shader that was put together");
        let is_needed = |s: &&Shared| needs.iter().any(|module| module.name == s.module);
        for Shared { module: name, layouts, constants } in shared().iter().filter(is_needed) {
            compared.insert(*name);
            assert_eq!(disagreements(layouts, constants, &module), [""; 0], "{}: {name}", shader.name);
        }
        assert_eq!(disagreements(shader.layouts, shader.constants, &module), [""; 0], "{}", shader.name);
    }
    let all: BTreeSet<_> = shared().iter().map(|s| s.module).collect();
    assert_eq!(compared, all, "modules that no shader needs");
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

#[test]
fn a_wrong_constant_is_found() {
    let module = parse("const A: u32 = 4u + 5u; override B: bool = true; struct C { v: array<vec4f, A>, }", "test");
    let right = [("A", 9.0), ("B", 1.0), ("C", 144.0)];
    assert_eq!(disagreements(&[], &right, &module), [""; 0]);
    for wrong in [("A", 8.0), ("B", 0.0), ("C", 140.0), ("D", 1.0)] {
        assert_eq!(disagreements(&[], &[wrong], &module).len(), 1, "{wrong:?}");
    }
}
