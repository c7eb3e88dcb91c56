// How maps store depth.

// Perspective views: falls linearly with the distance, from 1 at the light to 0 at the depth
// `farthest`, in place of near / distance.
override LINEAR: bool = false;

// What a map holds for a depth of 0 … 1. 0 is nothing, infinitely far.
fn stored_of(depth: f32, farthest: f32) -> f32 {
    if LINEAR {
        return 1.0 - farthest / max(depth, farthest);
    }
    return depth;
}

fn depth_of(stored: f32, farthest: f32) -> f32 {
    if LINEAR {
        return select(farthest / (1.0 - stored), 0.0, stored == 0.0);
    }
    return stored;
}
