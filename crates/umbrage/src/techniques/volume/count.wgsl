// needs: extrude
// Counts surfaces of shadow volumes in floats: each pixel adds up how many volumes a ray enters and
// leaves.

// From infinity, behind what is seen, instead of from the eye.
override FROM_INFINITY: bool = false;
// Every surface counts one, whichever way it faces (ZA 2.4.5).
override PARITY: bool = false;

@fragment
fn count(in: Corner, @builtin(front_facing) enters: bool) -> @location(0) f32 {
    return select(-in.times, in.times, (enters != FROM_INFINITY) || PARITY);
}
