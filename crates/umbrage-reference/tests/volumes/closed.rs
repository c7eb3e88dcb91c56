//! Every edge of a shadow volume is passed as often one way as the other.

use crate::shapes::{Setting, closed, damaged, setting, soup};
use crate::volume::{Corner, Volume};
use proptest::prelude::*;
use std::collections::BTreeMap;
use umbrage_core::adjacency::Adjacency;
use umbrage_core::silhouette::{Rule, light_in_mesh, loops};

fn check_is_closed((mesh, world_from_mesh, light): &Setting) {
    let adjacency = Adjacency::of(mesh);
    let light = light_in_mesh(*light, &world_from_mesh.inverse(), adjacency.center);
    for rule in [Rule::All, Rule::Away] {
        let volume = Volume::of(&adjacency, light, rule);
        let mut leaving = BTreeMap::<u32, i64>::new();
        for e in &volume.contour {
            *leaving.entry(e.from).or_default() += i64::from(e.times);
            *leaving.entry(e.to).or_default() -= i64::from(e.times);
        }
        assert!(leaving.values().all(|sum| *sum == 0), "{rule:?}: the contour is no cycle: {leaving:?}");
        let mut passed = BTreeMap::<[Corner; 2], i32>::new();
        for ([a, b, c], times) in &volume.triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                let sign = if from < to { *times } else { -times };
                *passed.entry([*from.min(to), *from.max(to)]).or_default() += sign;
            }
        }
        // What runs from the one point at infinity to itself is no edge.
        passed.retain(|[from, to], sum| from != to && *sum != 0);
        assert!(passed.is_empty(), "{rule:?}: open edges {passed:?}");
        let walked: usize = loops(&volume.contour).iter().map(Vec::len).sum();
        assert_eq!(walked, volume.contour.iter().map(|e| e.times as usize).sum::<usize>(), "{rule:?}");
    }
}

proptest! {
    #[test]
    fn volumes_of_any_triangles_are_closed(setting in setting(soup())) {
        check_is_closed(&setting);
    }

    #[test]
    fn volumes_of_closed_meshes_are_closed(setting in setting(closed())) {
        check_is_closed(&setting);
    }

    #[test]
    fn volumes_of_damaged_meshes_are_closed(setting in setting(damaged())) {
        check_is_closed(&setting);
    }
}
