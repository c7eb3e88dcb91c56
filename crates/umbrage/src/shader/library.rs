//! The modules of WGSL that any shader can need. Each lies beside the code that owns it.

use super::needs::Module;

macro_rules! modules {
    ($($folder:literal: $($name:ident)*;)*) => {
        &[$($(Module {
            name: stringify!($name),
            source: include_str!(concat!("../", $folder, "/", stringify!($name), ".wgsl")),
        },)*)*]
    };
}

pub(super) const LIBRARY: &[Module] = modules! {
    "wgsl": fullscreen inspect;
    "receivers": pack_normal eye receivers;
    "casters": instances casters materials many edges poses;
    "planar": plane_finder plane_shadow;
    "silhouettes": extrude;
    "area_light": area_light;
    "depth_maps/draw": map_storage map_view map_depth map_paraboloid contour_record map_edges;
    "depth_maps/lookup": map_layers map_lookup map_share map_visibility map_quick map_picture;
    "depth_maps/stages": light_kernel map_taps map_cells soft_taps;
    "moment_maps": moments_depth moments_float moments_unorm moments_mean moments_passes moments_share moments_lookup
        moments_soft;
};

/// Modules that stand for those of full-screen passes where a look-up of maps becomes a part of a
/// host's shader.
pub(super) const INLINE: &[Module] = &[
    Module { name: "map_visibility", source: include_str!("../depth_maps/lookup/map_inline.wgsl") },
    Module { name: "map_quick", source: "// needs: map_visibility" },
];

/// How a host packs the normals of [`crate::Receivers`]: WGSL with `pack_normal(normal, casts) ->
/// u32`.
pub const PACK_NORMAL: &str = include_str!("../receivers/pack_normal.wgsl");
