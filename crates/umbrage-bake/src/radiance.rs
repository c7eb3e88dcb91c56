//! What points send out under a sky.

use crate::storage::vectors;
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use umbrage_core::harmonics::{Light, Order};
use umbrage_core::transfer::{BakedMesh, Cluster, Stored};

/// What every point of a mesh sends out for a base colour of 1 under `light`, whose order is made
/// that of the transfer. Negative where the functions ring.
pub fn radiance(mesh: &BakedMesh, order: Order, light: &Light) -> Vec<Vec3> {
    let light = light.with_order(order);
    let Stored::Clustered { clusters, codes } = &mesh.stored else {
        let vectors = vectors(mesh, order);
        return vectors.par_chunks(mesh.vector_len(order)).map(|vector| product(vector, &light)).collect();
    };
    let lit: Vec<Vec<Vec3>> = clusters.iter().map(|cluster| cluster_radiance(cluster, &light)).collect();
    let point = |(number, k): (usize, &u16)| {
        let Some([mean, components @ ..]) = lit.get(usize::from(*k)).map(Vec::as_slice) else { return Vec3::ZERO };
        let weights = codes.weights.get(number * codes.vectors..).unwrap_or_default();
        *mean + components.iter().zip(weights).map(|(radiance, weight)| *radiance * *weight).sum::<Vec3>()
    };
    codes.cluster.par_iter().enumerate().map(point).collect()
}

/// R⁰ = mean · L and R^k = T^k · L, once for a cluster and a light of the transfer's order. A point
/// then sends out R⁰ + Σ w^k R^k: as many products as there are components, whatever the order.
pub fn cluster_radiance(cluster: &Cluster, light: &Light) -> Vec<Vec3> {
    let vectors = cluster.vectors.chunks_exact(cluster.mean.len().max(1));
    std::iter::once(&cluster.mean[..]).chain(vectors).map(|vector| product(vector, light)).collect()
}

/// Σ L_i T_i of a vector for all colours or for three.
fn product(vector: &[f32], light: &Light) -> Vec3 {
    let n = light.order().functions();
    let last = (vector.len() / n).clamp(1, 3) - 1;
    let of = |c: usize| {
        let channel = vector.get(c.min(last) * n..).unwrap_or_default();
        light.coefficients().iter().zip(channel).map(|(l, t)| l[c] * f64::from(*t)).sum::<f64>()
    };
    DVec3::new(of(0), of(1), of(2)).as_vec3()
}
