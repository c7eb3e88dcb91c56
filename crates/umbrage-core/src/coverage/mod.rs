//! How much of a light a caster covers, summed over the edges of its silhouette.
//!
//! Seen from a point, a light is a flat face: a disc, or a rectangle that its axes make a square.
//! Let D be that face, c its centre, and for each directed edge A the signed share of D that the
//! triangle between c and the edge takes, and S the signed share that lies within the angle under
//! which c sees the edge. Around closed loops Σ S is how often c itself is covered, the number of
//! hard shadows; Σ A is the covered share of D, by Green's theorem. So
//!
//! ```text
//! covered = hard + Σ (A − S)
//! ```
//!
//! and a term differs from 0 only where the edge runs across D: what lies outside of D has A = S.
//! Terms may be added in any order, for loops of any shape. Where c lies next to an edge S jumps by
//! a half each way, as `hard` jumps by 1: whoever counts `hard` has to ask [`double::is_left`] on
//! which side c is, of the same numbers, or pixels flicker.
//!
//! Sources: Assarsson and Akenine-Möller, "A Geometry-based Soft Shadow Volume Algorithm using
//! Graphics Hardware", 2003; SG "A Soft Shadow Volume Algorithm"; PX 4.1.5 and 4.2. That sum over
//! all edges is not in them.

mod cell;
mod sphere_table;
mod textured;

pub use cell::{Cell, NO_SIDE};
pub use sphere_table::SphereTable;
pub use textured::TexturedTable;

/// What a light looks like from a point, in coordinates (x, y) whose origin is its centre.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Face {
    /// Of radius 1.
    Disc,
    /// From −1 to 1 along both axes.
    Square,
}

/// The functions for one kind of float.
macro_rules! coverage {
    ($name:ident, $float:ident, $doc:literal) => {
        #[doc = $doc]
        ///
        /// Points are homogeneous, `[x, y, w]`: seen at (x / w, y / w) where `w` > 0, behind the
        /// observer where `w` < 0, in the light's plane where `w` = 1 and beyond it where `w` > 1.
        pub mod $name {
            use super::Face;
            use std::$float::consts::PI;

            /// Where an edge runs across a face.
            #[derive(Clone, Copy, Debug, PartialEq)]
            pub struct Chord {
                /// Its start on the face.
                pub from: [$float; 2],
                /// Its end.
                pub to: [$float; 2],
                /// True where the centre is on its left.
                pub is_left: bool,
            }

            /// True where the centre of the face is on the left of an edge, seen with x to the
            /// right and y up.
            pub fn is_left(from: [$float; 3], to: [$float; 3]) -> bool {
                from[0] * to[1] - from[1] * to[0] >= 0.0
            }

            /// A − S of an edge, see the module: what it adds to the covered share apart from what
            /// `hard` has of it.
            pub fn term(face: Face, from: [$float; 3], to: [$float; 3]) -> $float {
                chord(face, from, to).map_or(0.0, |chord| match face {
                    Face::Disc => chord.on_disc(),
                    Face::Square => chord.on_square(),
                })
            }

            /// The part of an edge that runs across the face, before the light and not behind the
            /// observer.
            pub fn chord(face: Face, from: [$float; 3], to: [$float; 3]) -> Option<Chord> {
                let is_left = is_left(from, to);
                let (from, to) = before_light(from, to)?;
                let [from, to] = match face {
                    Face::Disc => across_disc(from, to)?,
                    Face::Square => across_square(from, to)?,
                };
                Some(Chord { from, to, is_left })
            }

            impl Chord {
                /// The difference between triangle and sector on the disc.
                pub fn on_disc(&self) -> $float {
                    let (cross, dot) = self.products();
                    (cross - self.signed(cross.atan2(dot), 0.5 * PI)) / (2.0 * PI)
                }

                /// The same on the square.
                pub fn on_square(&self) -> $float {
                    self.products().0 / 8.0 - self.turn()
                }

                /// The share of the square within the angle under which its centre sees the chord.
                pub fn turn(&self) -> $float {
                    let turn = around_square(self.to) - around_square(self.from);
                    self.signed(turn - turn.round(), 0.25)
                }

                fn products(&self) -> ($float, $float) {
                    let ([a, b], [c, d]) = (self.from, self.to);
                    (a * d - b * c, a * c + b * d)
                }

                /// An angle that is near half a turn has the sign of the side that the centre is
                /// on.
                fn signed(&self, angle: $float, quarter: $float) -> $float {
                    let sign = if self.is_left { 1.0 } else { -1.0 };
                    if angle.abs() > quarter { sign * angle.abs() } else { angle }
                }
            }

            /// Where the ray from the centre through a point leaves the square, as a share 0…1 of
            /// the way around it. Sectors have areas in proportion.
            pub fn around_square([x, y]: [$float; 2]) -> $float {
                let longest = x.abs().max(y.abs());
                if longest == 0.0 {
                    return 0.0;
                }
                let (x, y) = (x / longest, y / longest);
                let way = if x == 1.0 {
                    1.0 + y
                } else if y == 1.0 {
                    3.0 - x
                } else if x == -1.0 {
                    5.0 - y
                } else {
                    7.0 + x
                };
                way / 8.0
            }

            /// The part that is nearer than the light's plane. What is cut off outside of the face
            /// had A = S.
            fn before_light(from: [$float; 3], to: [$float; 3]) -> Option<([$float; 3], [$float; 3])> {
                let cut = || mix(from, to, (1.0 - from[2]) / (to[2] - from[2]));
                match (from[2] <= 1.0, to[2] <= 1.0) {
                    (true, true) => Some((from, to)),
                    (true, false) => Some((from, cut())),
                    (false, true) => Some((cut(), to)),
                    (false, false) => None,
                }
            }

            fn mix(from: [$float; 3], to: [$float; 3], t: $float) -> [$float; 3] {
                [0, 1, 2].map(|i| from[i] + (to[i] - from[i]) * t)
            }

            fn across_disc(from: [$float; 3], to: [$float; 3]) -> Option<[[$float; 2]; 2]> {
                // The plane through observer and edge is the edge's line on the face: n.x x + n.y
                // y + n.z = 0.
                let n = [
                    from[1] * to[2] - from[2] * to[1],
                    from[2] * to[0] - from[0] * to[2],
                    from[0] * to[1] - from[1] * to[0],
                ];
                let square = n[0] * n[0] + n[1] * n[1];
                // False for what is not a number.
                let is_near = square > n[2] * n[2];
                if !is_near || (from[2] <= 0.0 && to[2] <= 0.0) {
                    return None;
                }
                let length = square.sqrt();
                let distance = n[2] / length;
                let half = (1.0 - distance * distance).max(0.0).sqrt();
                let along = [n[1] / length, -n[0] / length];
                let place = |p: [$float; 3]| (p[0] * along[0] + p[1] * along[1]) / p[2];
                // What comes from behind the observer comes from infinitely far away.
                let start = if from[2] > 0.0 { place(from).max(-half) } else { -half };
                let end = if to[2] > 0.0 { place(to).min(half) } else { half };
                let at = |s: $float| [along[0] * s - distance * n[0] / length, along[1] * s - distance * n[1] / length];
                (start < end).then(|| [at(start), at(end)])
            }

            fn across_square(from: [$float; 3], to: [$float; 3]) -> Option<[[$float; 2]; 2]> {
                let (mut start, mut end) = (0.0, 1.0);
                let sides = |[x, y, w]: [$float; 3]| [w + x, w - x, w + y, w - y];
                for (a, b) in sides(from).into_iter().zip(sides(to)) {
                    if a < 0.0 && b < 0.0 {
                        return None;
                    }
                    if a < 0.0 {
                        start = $float::max(start, a / (a - b));
                    } else if b < 0.0 {
                        end = $float::min(end, a / (a - b));
                    }
                }
                let at = |t| {
                    let [x, y, w] = mix(from, to, t);
                    [x / w, y / w]
                };
                let ends = [at(start), at(end)];
                (start < end && ends.as_flattened().iter().all(|c| c.is_finite())).then_some(ends)
            }
        }
    };
}

coverage!(double, f64, "In double precision.");
coverage!(single, f32, "In single precision, as shaders compute it.");

#[cfg(test)]
mod tests;
