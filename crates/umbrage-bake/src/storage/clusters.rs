//! Clusters of vectors, each with its own principal components.

use super::components::Components;
use rayon::prelude::*;
use umbrage_core::sampling::shift;
use umbrage_core::transfer::{Cluster, Codes, Stored};

/// Rounds at most in which every vector takes the cluster where it loses least, and every cluster
/// takes the components where its vectors lose least.
const MOST_ROUNDS: usize = 40;

/// What a round has to gain for another one, of all that is lost.
const WORTH_IT: f64 = 2e-3;

/// A cluster as vectors are compared with it.
struct Fitted {
    exact: Components,
    mean: Vec<f32>,
    /// One after the other.
    vectors: Vec<f32>,
}

/// The cluster that a vector is in, and the square of what it loses there.
type Choice = (u16, f32);

/// Stores `vectors` of `len` numbers: all in one cluster are principal components, clusters without
/// components are vector quantisation (Lloyd's algorithm), and both are clustered components, which
/// begin from the quantisation.
pub(super) fn clustered(vectors: &[f32], len: usize, clusters: usize, components: usize) -> Stored {
    let all = Vectors { vectors, len };
    let count = clusters.clamp(1, all.count().clamp(1, usize::from(u16::MAX)));
    let mut fitted: Vec<Fitted> = all.spread(count).map(|seed| Fitted::at(all.get(seed))).collect();
    let mut choices = all.choices(&fitted);
    let kinds = if components == 0 || count == 1 { &[components][..] } else { &[0, components] };
    for &components in kinds {
        let mut lost = f64::INFINITY;
        for _ in 0..MOST_ROUNDS {
            fitted = all.fitted(&choices, fitted, components);
            choices = all.choices(&fitted);
            let now = choices.iter().map(|choice| f64::from(choice.1)).sum::<f64>();
            if now >= (1.0 - WORTH_IT) * lost {
                break;
            }
            lost = now;
        }
    }
    all.stored(&fitted, &choices)
}

#[derive(Clone, Copy)]
struct Vectors<'a> {
    vectors: &'a [f32],
    len: usize,
}

impl<'a> Vectors<'a> {
    fn count(&self) -> usize {
        self.vectors.len() / self.len
    }

    fn get(&self, number: usize) -> &'a [f32] {
        self.vectors.get(number * self.len..(number + 1) * self.len).unwrap_or_default()
    }

    /// Numbers of vectors to begin with: the farther one is from those before, the more likely it
    /// is (Arthur and Vassilvitskii, "k-means++", 2007), with the same dice every time.
    fn spread(&self, count: usize) -> impl Iterator<Item = usize> {
        let mut distances = vec![f32::INFINITY; self.count()];
        let (mut chosen, mut next) = (Vec::with_capacity(count), 0);
        for number in 0..count {
            chosen.push(next);
            let seed = self.get(next);
            distances.par_iter_mut().enumerate().for_each(|(i, d)| *d = d.min(squared(self.get(i), seed)));
            let all: f64 = distances.iter().map(|d| f64::from(*d)).sum();
            let mut left = shift(number as u32).x * all;
            let reached = |d: &f32| {
                left -= f64::from(*d);
                left < 0.0
            };
            next = distances.iter().position(reached).unwrap_or(number + 1);
        }
        chosen.into_iter()
    }

    fn choices(&self, fitted: &[Fitted]) -> Vec<Choice> {
        let best = |off: &mut Vec<f32>, number: usize| {
            let mut best = (0, f32::INFINITY);
            for (cluster, k) in fitted.iter().zip(0..) {
                let loss = cluster.loss(self.get(number), off);
                if loss < best.1 {
                    best = (k, loss);
                }
            }
            best
        };
        (0..self.count()).into_par_iter().with_min_len(64).map_init(Vec::new, best).collect()
    }

    /// Clusters fitted to the vectors that chose them. One that nobody chose takes the vector that
    /// loses most.
    fn fitted(&self, choices: &[Choice], before: Vec<Fitted>, components: usize) -> Vec<Fitted> {
        let mut members = vec![Vec::new(); before.len()];
        choices.iter().enumerate().for_each(|(number, choice)| members[usize::from(choice.0)].push(number));
        let mut worst: Vec<usize> = (0..choices.len()).collect();
        if members.iter().any(Vec::is_empty) {
            worst.sort_by(|a, b| choices[*b].1.total_cmp(&choices[*a].1));
        }
        let mut worst = worst.into_iter();
        for empty in members.iter_mut().filter(|members| members.is_empty()) {
            empty.extend(worst.next());
        }
        let fit = |(members, before): (Vec<usize>, Fitted)| {
            let vectors = members.iter().map(|&number| self.get(number));
            Fitted::new(Components::fit(vectors, self.len, components, &before.exact))
        };
        members.into_par_iter().zip(before).map(fit).collect()
    }

    fn stored(&self, fitted: &[Fitted], choices: &[Choice]) -> Stored {
        let components = fitted.first().map_or(0, |cluster| cluster.vectors.len() / self.len);
        let cluster: Vec<u16> = choices.iter().map(|choice| choice.0).collect();
        let weights = |(number, k): (usize, &u16)| fitted[usize::from(*k)].weights(self.get(number));
        let weights = cluster.iter().enumerate().flat_map(weights).collect();
        let whole = |f: &Fitted| Cluster { mean: f.mean.clone(), vectors: f.vectors.clone() };
        Stored::Clustered {
            clusters: fitted.iter().map(whole).collect(),
            codes: Codes { cluster, vectors: components, weights },
        }
    }
}

impl Fitted {
    fn new(exact: Components) -> Self {
        let mean = exact.mean.iter().map(|value| *value as f32).collect();
        let vectors = exact.vectors.iter().flatten().map(|value| *value as f32).collect();
        Self { exact, mean, vectors }
    }

    fn at(mean: &[f32]) -> Self {
        Self::new(Components { mean: mean.iter().map(|value| f64::from(*value)).collect(), vectors: Vec::new() })
    }

    /// The square of what is lost of a vector; `off` is made what it is off the mean.
    fn loss(&self, vector: &[f32], off: &mut Vec<f32>) -> f32 {
        off.clear();
        off.extend(vector.iter().zip(&self.mean).map(|(x, m)| x - m));
        let mut loss = dot(off, off);
        for component in self.vectors.chunks_exact(vector.len()) {
            let along = dot(off, component);
            loss -= along * along;
        }
        loss.max(0.0)
    }

    /// What of each component is in a vector.
    fn weights(&self, vector: &[f32]) -> Vec<f32> {
        let off: Vec<f32> = vector.iter().zip(&self.mean).map(|(x, m)| x - m).collect();
        self.vectors.chunks_exact(vector.len()).map(|component| dot(&off, component)).collect()
    }
}

/// In eight sums side by side, which processors add at once.
fn dot(a: &[f32], b: &[f32]) -> f32 {
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<8>(), b.as_chunks::<8>());
    let mut sums = [0.0; 8];
    for (a, b) in a.iter().zip(b) {
        (0..8).for_each(|k| sums[k] += a[k] * b[k]);
    }
    let rest: f32 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f32>() + rest
}

fn squared(a: &[f32], b: &[f32]) -> f32 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}
