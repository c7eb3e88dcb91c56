//! Wavefront OBJ.
//!
//! Polygons of any simple shape are cut into triangles, and every triangle is kept as it is, also
//! degenerate and repeated ones. A mesh is made for every object and material. Faces without
//! normals get smooth ones.
//!
//! The reader is the project's own since `tobj` names no line in its errors, panics on an MTL
//! colour of two numbers, takes an index of 0 for an absent one, and mixes up vertices of which
//! only some have texture coordinates. (Source: Wavefront, "Advanced Visualizer manual", appendix
//! B1.)

use crate::error::{self, Error, Place, shown};
use crate::files::Files;
use crate::limits::{MOST_CORNERS, MOST_TRIANGLES};
use crate::lines::{self, Line};
use crate::model::{Hold, Model, Part, is_usable, is_usable_uv};
use crate::mtl::{Library, Lookup};
use crate::polygon::{Cut, Cutter};
use crate::text;
use glam::{Vec2, Vec3};
use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::path::{Path, PathBuf};
use umbrage_core::{Material, Mesh};

/// Indices from 0 of position, texture coordinate and normal of a corner; `NONE` where it has none.
type Corner = [u32; 3];
const NONE: u32 = u32::MAX;

/// Characters of a name that go into those of meshes.
const LONGEST_NAME: usize = 60;

/// Kinds of lines that are not read and that notes name one by one.
const MOST_KEYWORDS: usize = 8;

/// What helps against numbers beyond all bounds.
const TOO_FAR: &str = "mend it, or export the file again in metres";

/// A polygon as written.
struct Face {
    line: usize,
    /// Into [`Contents::groups`].
    group: usize,
    /// Into [`Contents::corners`].
    corners: Range<usize>,
}

/// Faces of one object and material, by the numbers of their names.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
struct Group {
    object: Option<usize>,
    material: Option<usize>,
}

/// Names, each once.
#[derive(Default)]
struct Names {
    names: Vec<String>,
    numbers: HashMap<String, usize>,
}

impl Names {
    fn number(&mut self, name: &str) -> usize {
        if let Some(number) = self.numbers.get(name) {
            return *number;
        }
        self.numbers.insert(name.to_owned(), self.names.len());
        self.names.push(name.to_owned());
        self.names.len() - 1
    }

    fn get(&self, number: Option<usize>) -> Option<&str> {
        number.and_then(|n| self.names.get(n)).map(String::as_str)
    }
}

/// What the lines of the file say.
#[derive(Default)]
struct Contents {
    positions: Vec<Vec3>,
    uvs: Vec<Vec2>,
    normals: Vec<Vec3>,
    corners: Vec<Corner>,
    faces: Vec<Face>,
    names: Names,
    groups: Vec<Group>,
    index_of_group: HashMap<Group, usize>,
    /// The group that faces belong to from here on.
    current: Group,
    library: Library,
    /// Libraries that were read.
    libraries: HashSet<PathBuf>,
    /// Elements and keywords that were left out, with the line of the first one.
    left_out: HashMap<String, usize>,
}

/// Reads an OBJ file and the material libraries it names.
pub(crate) fn read(files: Files<'_>, file: &Path) -> Result<Model, Error> {
    let text = text::decode_old(file, files.read(file)?)?;
    let mut contents = Contents::default();
    lines::for_each(file, &text, |line| contents.read_line(files, file, &line))?;
    contents.check_indices(file)?;
    let triangles = contents.cut(file)?;
    Ok(contents.into_model(file, &triangles))
}

impl Contents {
    fn read_line(&mut self, files: Files<'_>, file: &Path, line: &Line<'_>) -> Result<(), Error> {
        match line.keyword {
            "v" => {
                let position = Vec3::from(line.numbers::<3>()?);
                if !is_usable(position) {
                    return Err(line.error(format!("vertex {position} is too far away")).remedy(TOO_FAR));
                }
                self.positions.push(position);
            }
            "vt" => {
                // A texture may be one-dimensional. Row 0 of a picture is its top, v = 1.
                let u = line.numbers::<1>()?[0];
                let v = if line.rest.contains(char::is_whitespace) { line.numbers::<2>()?[1] } else { 0.0 };
                let uv = Vec2::new(u, 1.0 - v);
                if !is_usable_uv(uv) {
                    return Err(line.error(format!("texture coordinate {uv} is too large")).remedy(TOO_FAR));
                }
                self.uvs.push(uv);
            }
            "vn" => self.normals.push(Vec3::from(line.numbers()?)),
            "f" | "fo" => self.read_face(line)?,
            "o" => self.current.object = Some(self.names.number(line.rest)),
            "usemtl" => self.current.material = Some(self.names.number(line.rest)),
            "mtllib" => self.read_library(files, file, line)?,
            // Names of groups, smoothing, and display attributes, none of which changes the
            // surface.
            "g" | "s" | "mg" | "vp" | "bevel" | "c_interp" | "d_interp" | "lod" | "shadow_obj" | "trace_obj" => {}
            other => {
                self.left_out.entry(error::line(other)).or_insert(line.number);
            }
        }
        Ok(())
    }

    fn read_face(&mut self, line: &Line<'_>) -> Result<(), Error> {
        let start = self.corners.len();
        for word in line.rest.split_ascii_whitespace().take_while(|word| !word.starts_with('#')) {
            let mut corner = [NONE; 3];
            let counts = [self.positions.len(), self.uvs.len(), self.normals.len()];
            for (i, part) in word.split('/').enumerate() {
                match (corner.get_mut(i), i, part) {
                    (Some(_), 1 | 2, "") => {}
                    (Some(index), ..) => *index = parse_index(part, counts[i]).ok_or_else(|| bad_corner(line, word))?,
                    (None, ..) => return Err(bad_corner(line, word)),
                }
            }
            self.corners.push(corner);
        }
        let count = self.corners.len() - start;
        if count < 3 {
            return Err(line
                .error(format!("a face needs 3 corners and has {count}"))
                .remedy("the file may be cut off or damaged: export it again"));
        }
        if self.corners.len() as u64 > 3 * MOST_TRIANGLES {
            let what = format!("has more than {MOST_TRIANGLES} triangles");
            return Err(line.error(what).remedy("split the file, or export less detail"));
        }
        let group = *self.index_of_group.entry(self.current).or_insert_with(|| {
            self.groups.push(self.current);
            self.groups.len() - 1
        });
        self.faces.push(Face { line: line.number, group, corners: start..self.corners.len() });
        Ok(())
    }

    /// Reads a material library. A missing one is common, and noted; what is wrong inside one is an
    /// error.
    fn read_library(&mut self, files: Files<'_>, file: &Path, line: &Line<'_>) -> Result<(), Error> {
        let dir = file.parent().unwrap_or(Path::new(""));
        let whole = dir.join(line.rest.replace('\\', "/"));
        // Where that is not one name with spaces, it is several names.
        let names = if files.is_missing(&whole) { line.rest.split_whitespace().collect() } else { vec![line.rest] };
        for name in names {
            let path = dir.join(name.replace('\\', "/"));
            if !self.libraries.insert(path.clone()) {
                continue;
            }
            if !files.is_missing(&path) {
                let bytes = files.read(&path).map_err(|e| line.error("`mtllib` names").passing_on(&e))?;
                self.library.read(files, &path, bytes)?;
                continue;
            }
            self.library.notes.push(format!(
                "{}:{}: material library `{}` is missing: default materials are used",
                shown(file),
                line.number,
                error::line(name)
            ));
        }
        Ok(())
    }

    /// Faces may name vertices that come later in the file, so that indices are checked at its end.
    fn check_indices(&self, file: &Path) -> Result<(), Error> {
        let counts = [self.positions.len(), self.uvs.len(), self.normals.len()];
        let names = ["vertices", "texture coordinates", "normals"];
        for face in &self.faces {
            for corner in &self.corners[face.corners.clone()] {
                for ((&index, count), name) in corner.iter().zip(counts).zip(names) {
                    if index != NONE && index as usize >= count {
                        let what = format!("index {} is out of range: the file has {count} {name}", index as u64 + 1);
                        return Err(Error::new(file, what)
                            .at(Place::Line(face.line, None))
                            .remedy("the file may be cut off or damaged: export it again"));
                    }
                }
            }
        }
        Ok(())
    }

    /// Cuts every face into triangles: of each its group, and its corners in [`Contents::corners`].
    fn cut(&mut self, file: &Path) -> Result<Vec<(usize, [u32; 3])>, Error> {
        let mut cutter = Cutter::default();
        let mut all = Vec::with_capacity(self.corners.len() - 2 * self.faces.len());
        let (mut points, mut triangles) = (Vec::new(), Vec::new());
        let mut crossing: Option<(usize, usize)> = None;
        for face in &self.faces {
            points.clear();
            triangles.clear();
            points.extend(self.corners[face.corners.clone()].iter().map(|c| self.positions[c[0] as usize]));
            match cutter.cut(&points, &mut triangles) {
                Cut::Right => {}
                Cut::Crossing => crossing.get_or_insert((face.line, 0)).1 += 1,
                Cut::TooLong => {
                    let what =
                        format!("a concave polygon has {} corners; at most {MOST_CORNERS} are cut", points.len());
                    return Err(Error::new(file, what)
                        .at(Place::Line(face.line, None))
                        .remedy("export the model with triangles"));
                }
            }
            let start = face.corners.start as u32;
            all.extend(triangles.iter().map(|t| (face.group, t.map(|i| start + i))));
        }
        if let Some((line, count)) = crossing {
            let polygons =
                if count == 1 { "a polygon crosses itself and was" } else { "polygons cross themselves and were" };
            let number = if count == 1 { String::new() } else { format!("{count} ") };
            self.library.notes.push(format!("{}:{line}: {number}{polygons} cut as a fan", shown(file)));
        }
        Ok(all)
    }

    fn into_model(mut self, file: &Path, triangles: &[(usize, [u32; 3])]) -> Model {
        let smooth = self.smooth_normals(triangles);
        let mut model = Model::default();
        let mut builders: Vec<MeshBuilder> = self.groups.iter().map(|g| MeshBuilder::new(&self, g)).collect();
        for (group, corners) in triangles {
            corners.iter().for_each(|c| builders[*group].add(self.corners[*c as usize], &self, &smooth));
        }
        let default = self.library.materials.len();
        let mut uses_default = false;
        for (builder, group) in builders.into_iter().zip(&self.groups) {
            let material = self.names.get(group.material);
            let known = material.and_then(|name| self.library.by_name.get(name)).copied();
            if let (None, Some(name), false) = (known, material, self.library.by_name.is_empty()) {
                self.library.notes.push(format!(
                    "{}: material `{}` is in none of its libraries: the default material is used",
                    shown(file),
                    error::line(name)
                ));
            }
            uses_default |= known.is_none();
            model.parts.push(Part { mesh: model.meshes.len(), material: known.unwrap_or(default), hold: Hold::Model });
            model.meshes.push(builder.mesh);
        }
        if uses_default {
            self.library.materials.push(Material::default());
        }
        model.materials = self.library.materials;
        model.textures = self.library.textures;
        model.notes = self.library.notes;
        let mut left_out: Vec<_> = self.left_out.into_iter().collect();
        left_out.sort_by_key(|(_, line)| *line);
        let more = left_out.len().saturating_sub(MOST_KEYWORDS);
        model.notes.extend(
            left_out
                .into_iter()
                .take(MOST_KEYWORDS)
                .map(|(keyword, line)| format!("{}:{line}: `{keyword}` is not read and was left out", shown(file))),
        );
        if more > 0 {
            model.notes.push(format!("{}: {more} more kinds of lines are not read and were left out", shown(file)));
        }
        model
    }

    /// A normal for every position, from all faces around it: also where texture coordinates,
    /// objects or materials split the vertex. Empty where every corner has a normal of its own.
    fn smooth_normals(&mut self, triangles: &[(usize, [u32; 3])]) -> Vec<Vec3> {
        if self.corners.iter().all(|c| c[2] != NONE) {
            return Vec::new();
        }
        let indices = triangles.iter().flat_map(|(_, t)| t.map(|c| self.corners[c as usize][0])).collect();
        let mut mesh = Mesh { positions: std::mem::take(&mut self.positions), indices, ..Mesh::default() };
        mesh.generate_normals_if_absent();
        self.positions = mesh.positions;
        mesh.normals
    }
}

/// Turns corners into vertices: equal corners are one vertex.
struct MeshBuilder {
    mesh: Mesh,
    lookup: Lookup,
    vertex_of_corner: HashMap<Corner, u32>,
}

impl MeshBuilder {
    fn new(contents: &Contents, group: &Group) -> Self {
        let named = |name| contents.names.get(name).unwrap_or_default();
        let [object, material] = [group.object, group.material].map(named);
        let known = contents.library.by_name.get(material);
        let lookup = known.and_then(|number| contents.library.lookups.get(*number)).copied().unwrap_or_default();
        let [object, material] = [object, material].map(|name| text::printable(name, LONGEST_NAME));
        let name = format!("{object} {material}").trim().to_owned();
        Self { mesh: Mesh { name, ..Mesh::default() }, lookup, vertex_of_corner: HashMap::new() }
    }

    fn add(&mut self, corner: Corner, contents: &Contents, smooth: &[Vec3]) {
        let mesh = &mut self.mesh;
        let vertex = *self.vertex_of_corner.entry(corner).or_insert_with(|| {
            let [position, uv, normal] = corner.map(|i| i as usize);
            let own = contents.normals.get(normal).and_then(|n| n.try_normalize());
            let smooth = smooth.get(position).copied().unwrap_or(Vec3::Y);
            mesh.positions.push(contents.positions[position]);
            mesh.normals.push(own.unwrap_or(smooth));
            if !contents.uvs.is_empty() {
                mesh.uvs.push(self.lookup.place(contents.uvs.get(uv).copied().unwrap_or_default()));
            }
            mesh.positions.len() as u32 - 1
        });
        mesh.indices.push(vertex);
    }
}

/// An index from 0 out of one from 1, or out of a negative one that counts back from `count`.
fn parse_index(word: &str, count: usize) -> Option<u32> {
    let index: i64 = word.parse().ok()?;
    let from_zero = if index < 0 { count as i64 + index } else { index - 1 };
    u32::try_from(from_zero).ok().filter(|&i| i != NONE)
}

fn bad_corner(line: &Line<'_>, word: &str) -> Error {
    line.error(format!("`{word}` is not a corner of a face"))
        .remedy("a corner is v, v/vt, v//vn or v/vt/vn, counted from 1, or from -1 backwards")
}
