//! [`Bitmap`]: a drawing backend on RGB pixels.
//!
//! A wide stroke is the union of the capsules around its segments: round joins and round caps, so that no pixel is farther
//! from the curve than half the width. The backend that plotters offers fills one polygon for the whole path instead. Its
//! corners on the inner side of a sharp turn have no bound: a noisy curve showed spikes that are not in the data.

use std::convert::Infallible;

use plotters_backend::{BackendColor, BackendCoord, BackendStyle, DrawingBackend, DrawingErrorKind, rasterizer};

type Result<T> = std::result::Result<T, DrawingErrorKind<Infallible>>;

/// RGB pixels, row by row, white at first.
#[derive(Debug)]
pub(super) struct Bitmap<'p> {
    pixels: &'p mut [u8],
    width: u32,
    height: u32,
}

impl<'p> Bitmap<'p> {
    /// A white bitmap of that size in `pixels`.
    pub(super) fn new(pixels: &'p mut Vec<u8>, width: u32, height: u32) -> Self {
        pixels.clear();
        pixels.resize((width * height * 3) as usize, u8::MAX);
        Bitmap { pixels, width, height }
    }

    /// Fills the pixels whose centres are within half of `width` of the segment.
    fn capsule(&mut self, from: BackendCoord, to: BackendCoord, width: u32, color: BackendColor) -> Result<()> {
        let radius = 0.5 * f64::from(width);
        let reach = width.div_ceil(2) as i32;
        let (size_x, size_y) = (self.width as i32 - 1, self.height as i32 - 1);
        let columns = (from.0.min(to.0) - reach).max(0)..=(from.0.max(to.0) + reach).min(size_x);
        let rows = (from.1.min(to.1) - reach).max(0)..=(from.1.max(to.1) + reach).min(size_y);
        let (x, y) = (f64::from(to.0 - from.0), f64::from(to.1 - from.1));
        let square = x * x + y * y;
        for row in rows {
            for column in columns.clone() {
                let (dx, dy) = (f64::from(column - from.0), f64::from(row - from.1));
                let along = if square > 0.0 { ((dx * x + dy * y) / square).clamp(0.0, 1.0) } else { 0.0 };
                let (dx, dy) = (dx - along * x, dy - along * y);
                if dx * dx + dy * dy <= radius * radius {
                    self.draw_pixel((column, row), color)?;
                }
            }
        }
        Ok(())
    }
}

impl DrawingBackend for Bitmap<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    fn ensure_prepared(&mut self) -> Result<()> {
        Ok(())
    }

    fn present(&mut self) -> Result<()> {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, color: BackendColor) -> Result<()> {
        let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) else { return Ok(()) };
        if x < self.width && y < self.height {
            let start = ((y * self.width + x) * 3) as usize;
            let (red, green, blue) = color.rgb;
            for (pixel, value) in self.pixels[start..start + 3].iter_mut().zip([red, green, blue]) {
                let old = f64::from(*pixel);
                *pixel = (old + color.alpha * (f64::from(value) - old)).round() as u8;
            }
        }
        Ok(())
    }

    fn draw_line<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, style: &S) -> Result<()> {
        match style.stroke_width() {
            0 | 1 => rasterizer::draw_line(self, from, to, style),
            width => self.capsule(from, to, width, style.color()),
        }
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, path: I, style: &S) -> Result<()> {
        let mut path = path.into_iter();
        let Some(mut from) = path.next() else { return Ok(()) };
        for to in path {
            self.draw_line(from, to, style)?;
            from = to;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Style(u32);

    impl BackendStyle for Style {
        fn color(&self) -> BackendColor {
            BackendColor { alpha: 1.0, rgb: (200, 0, 0) }
        }

        fn stroke_width(&self) -> u32 {
            self.0
        }
    }

    /// Rows that have a coloured pixel, of a path between rows 40 and 60 of a bitmap of 100 rows.
    fn rows(path: &[BackendCoord], width: u32) -> Vec<usize> {
        let mut pixels = Vec::new();
        Bitmap::new(&mut pixels, 200, 100).draw_path(path.iter().copied(), &Style(width)).unwrap();
        let is_colored = |row: &usize| pixels[row * 600..(row + 1) * 600].chunks(3).any(|pixel| pixel != [255; 3]);
        (0..100).filter(is_colored).collect()
    }

    /// Law: however sharp its turns are, a stroke stays within half its width of the path.
    #[test]
    fn sharp_turns_make_no_spikes() {
        for width in [2, 3, 5] {
            let zigzag: Vec<BackendCoord> = (0..200).map(|x| (x, if x % 2 == 0 { 40 } else { 60 })).collect();
            let found = rows(&zigzag, width);
            let reach = (width / 2) as usize;
            assert_eq!((found[0], found[found.len() - 1]), (40 - reach, 60 + reach), "width {width}");
        }
    }

    /// Counter-test: one polygon around the whole path, as plotters draws it, leaves the path.
    #[test]
    fn a_polygon_around_the_path_makes_spikes() {
        let zigzag: Vec<BackendCoord> = (0..200).map(|x| (x, if x % 2 == 0 { 40 } else { 60 })).collect();
        let corners = rasterizer::polygonize(&zigzag, 3);
        assert!(corners.iter().any(|(_, y)| !(38..=62).contains(y)));
    }
}
