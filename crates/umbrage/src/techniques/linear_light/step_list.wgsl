// What finding steps in a map leaves for the draw of skins.

// Skins in a group that is drawn as one instance, and the indices of each.
const GROUP: u32 = 64u;
const INDICES: u32 = 6u;

// Corner of a cell of 2 × 2 texels, going around.
fn corner_of(cell: vec2u, corner: u32) -> vec2u {
    let k = corner & 3u;
    return cell + vec2u(u32(k == 1u || k == 2u), k >> 1u);
}

// Cell, layer, and the two of the cell's sides that the border between blocker and receiver goes
// through: at the first, going around, from the blocker to the receiver, at the second back.
fn packed(cell: vec2u, layer: u32, down: u32, up: u32) -> vec2u {
    return vec2u(cell.x | (cell.y << 16u), layer | (down << 4u) | (up << 6u));
}
