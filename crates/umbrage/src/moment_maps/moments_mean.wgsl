// The mean of moments is their sum, weighted. (Exponential maps keep logarithms and differ.)

// What can be summed of `m`; `top` is the largest of all.
fn summand(m: vec4f, top: vec4f) -> vec4f {
    return m;
}

fn mean_of(sum: vec4f, top: vec4f) -> vec4f {
    return sum;
}
