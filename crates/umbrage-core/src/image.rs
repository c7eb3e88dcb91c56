//! A picture as plain data.

/// `width` × `height` values, row 0 at the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Image<T> {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// `width * height` values, row by row.
    pub data: Vec<T>,
}

impl<T> Image<T> {
    /// A picture whose pixel (x, y) is `f(x, y)`.
    pub fn from_fn(width: u32, height: u32, mut f: impl FnMut(u32, u32) -> T) -> Self {
        let data = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| f(x, y)).collect();
        Self { width, height, data }
    }

    /// Width and height.
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// The value at (x, y), or `None` outside.
    pub fn get(&self, x: i64, y: i64) -> Option<&T> {
        let inside = (0..i64::from(self.width)).contains(&x) && (0..i64::from(self.height)).contains(&y);
        if inside { self.data.get((y * i64::from(self.width) + x) as usize) } else { None }
    }

    /// A picture of the same size with `f` of every value.
    pub fn map<U>(&self, f: impl FnMut(&T) -> U) -> Image<U> {
        Image { width: self.width, height: self.height, data: self.data.iter().map(f).collect() }
    }
}

impl<T: Clone> Image<T> {
    /// A picture of one value.
    pub fn filled(width: u32, height: u32, value: T) -> Self {
        Self { width, height, data: vec![value; width as usize * height as usize] }
    }
}

impl<T> std::ops::Index<(u32, u32)> for Image<T> {
    type Output = T;
    fn index(&self, (x, y): (u32, u32)) -> &T {
        &self.data[(y * self.width + x) as usize]
    }
}

impl<T> std::ops::IndexMut<(u32, u32)> for Image<T> {
    fn index_mut(&mut self, (x, y): (u32, u32)) -> &mut T {
        &mut self.data[(y * self.width + x) as usize]
    }
}
