//! Building bounding volume hierarchies.

use obvhs::bvh2::{Bvh2, leaf_collapser::collapse, reinsertion::ReinsertionOptimizer};
use obvhs::{Boundable, BvhBuildParams, ploc::PlocBuilder};

/// The hierarchy over `things`: `obvhs::bvh2::builder::build_bvh2` without the clock that it reads,
/// since browsers have none where it looks.
pub(crate) fn build(things: &[impl Boundable], params: BvhBuildParams) -> Bvh2 {
    let numbers = (0..things.len() as u32).collect();
    let mut tree = PlocBuilder::with_capacity(things.len()).build(
        params.ploc_search_distance,
        things,
        numbers,
        params.sort_precision,
        params.search_depth_threshold,
    );
    let again = params.reinsertion_batch_ratio * params.post_collapse_reinsertion_batch_ratio_multiplier;
    let mut optimizer = ReinsertionOptimizer::default();
    optimizer.run(&mut tree, params.reinsertion_batch_ratio, None);
    collapse(&mut tree, params.max_prims_per_leaf.clamp(1, 255), params.collapse_traversal_cost);
    optimizer.run(&mut tree, again, None);
    tree
}

#[cfg(test)]
mod tests {
    use super::*;
    use obvhs::aabb::Aabb;

    #[test]
    fn the_hierarchy_is_that_of_the_crate() {
        let boxes: Vec<Aabb> = (0..500)
            .map(|i| [i * 37 % 100, i * 11 % 17, i * 7 % 23].map(|v| v as f32))
            .map(|p| Aabb::new(p.into(), p.map(|v| v + 1.5).into()))
            .collect();
        for params in [BvhBuildParams::fastest_build, BvhBuildParams::medium_build, BvhBuildParams::slow_build] {
            let theirs = obvhs::bvh2::builder::build_bvh2(&boxes, params(), &mut Default::default());
            let ours = build(&boxes, params());
            let lines = |tree: &Bvh2| tree.nodes.iter().map(|n| format!("{n:?}")).collect::<Vec<_>>();
            assert_eq!(lines(&ours), lines(&theirs));
            assert_eq!(ours.primitive_indices, theirs.primitive_indices);
        }
    }
}
