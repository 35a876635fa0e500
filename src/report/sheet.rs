//! [`Sheet`]: figures on one picture, in rows of twelve columns as on the page.

use crate::campaign::Display;
use crate::report::figure::Figure;
use crate::report::legend::Legend;
use crate::report::panel::Panel;
use crate::report::svg::{Anchor, Font, INK, Letters, Svg};

/// Size and height of the title, pixels.
const TITLE: f64 = 19.0;
const TITLE_HEIGHT: f64 = 40.0;
/// Free width on both sides, pixels.
const EDGE: f64 = 20.0;
/// Free height at the bottom, pixels.
const BOTTOM: f64 = 8.0;
/// Size of the letters of a caption, and height of its lines, pixels.
const CAPTION: f64 = 11.5;
const CAPTION_LINE: f64 = 16.0;
/// Size of a picture of one figure, pixels.
const ALONE: [f64; 2] = [720.0, 440.0];

/// Figures that are one file.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// Title of the whole; empty where it has none.
    pub title: String,
    /// Usual width, pixels.
    pub width: f64,
    /// Usual height of a panel, pixels.
    pub panel_height: f64,
    /// Whether one legend is that of all panels.
    pub has_common_legend: bool,
    /// The figures, each as wide as its columns of twelve.
    pub panels: Vec<Figure>,
}

/// Where a panel is: corner, width and height.
type Place = ([f64; 2], [f64; 2]);

impl Sheet {
    /// The same in the units of `display`.
    #[must_use]
    pub fn in_units(self, display: &Display) -> Self {
        Sheet { panels: self.panels.into_iter().map(|panel| panel.in_units(display)).collect(), ..self }
    }

    /// A picture of one figure with its caption.
    pub fn of(figure: &Figure) -> Self {
        let [width, panel_height] = ALONE;
        let panels = vec![Figure { columns: 12, ..figure.clone() }];
        Sheet { title: String::new(), width, panel_height, has_common_legend: false, panels }
    }

    /// What stands below the panel of a picture of one figure.
    fn caption(&self) -> &str {
        match &self.panels[..] {
            [figure] if self.title.is_empty() => &figure.caption,
            _ => "",
        }
    }

    /// The caption in lines for a picture so wide, pixels.
    fn caption_lines(&self, font: &Font, width: f64) -> Vec<String> {
        let room = width - 2.0 * EDGE;
        let mut lines: Vec<String> = Vec::new();
        for word in self.caption().split_whitespace() {
            match lines.last_mut() {
                Some(line) if font.width(&format!("{line} {word}"), CAPTION) <= room => {
                    line.push(' ');
                    line.push_str(word);
                }
                _ => lines.push(font.fitted(word, room, CAPTION)),
            }
        }
        lines
    }

    /// Free height at the bottom, with the caption, pixels.
    fn bottom(&self, font: &Font, width: f64) -> f64 {
        let lines = self.caption_lines(font, width).len();
        BOTTOM + if lines > 0 { BOTTOM + CAPTION_LINE * lines as f64 } else { 0.0 }
    }

    fn legend(&self, font: &Font, width: f64) -> Legend<'_> {
        if !self.has_common_legend {
            return Legend::default();
        }
        Legend::new(font, self.panels.iter().flat_map(|panel| &panel.marks), width - 2.0 * EDGE)
    }

    /// The size of the picture, and where its panels are. `size` is what is given instead of the usual one: the axes have what texts leave.
    fn layout(&self, font: &Font, size: Option<[f64; 2]>) -> ([f64; 2], Vec<Place>) {
        let width = size.map_or(self.width, |size| size[0]);
        let top = if self.title.is_empty() { 0.0 } else { TITLE_HEIGHT } + self.legend(font, width).height();
        let mut rows: Vec<(u8, f64, Vec<Place>)> = Vec::new();
        for panel in &self.panels {
            let room = f64::from(panel.columns) / 12.0 * width;
            let height = panel.height(font, room, self.panel_height, !self.has_common_legend);
            if rows.last().is_none_or(|(used, ..)| used + panel.columns > 12) {
                rows.push((0, 0.0, Vec::new()));
            }
            if let Some((used, highest, places)) = rows.last_mut() {
                places.push(([f64::from(*used) / 12.0 * width, 0.0], [room, height]));
                (*used, *highest) = (*used + panel.columns, highest.max(height));
            }
        }
        let usual = rows.iter().map(|row| row.1).sum::<f64>();
        let bottom = self.bottom(font, width);
        let height = size.map_or(top + usual + bottom, |size| size[1]);
        let scale = ((height - top - bottom) / usual).max(0.0);
        let (mut y, mut places) = (top, Vec::new());
        for (_, highest, row) in rows {
            places.extend(row.into_iter().map(|([x, _], [width, _])| ([x, y], [width, scale * highest])));
            y += scale * highest;
        }
        ([width, height], places)
    }

    /// The picture as SVG, of `size` pixels of 1/96 inch where that is given.
    pub fn svg(&self, size: Option<[f64; 2]>) -> String {
        self.svg_with(size, Letters::Outlines)
    }

    /// The same with `letters` as outlines or as text.
    pub(super) fn svg_with(&self, size: Option<[f64; 2]>, letters: Letters) -> String {
        let font = Font::new();
        let (size, places) = self.layout(&font, size);
        let mut svg = Svg::new(font, size, letters);
        if !self.title.is_empty() {
            let title = svg.font.fitted(&self.title, size[0] - 2.0 * EDGE, TITLE);
            svg.text(&title, [0.5 * size[0], 27.0], TITLE, Anchor::Middle, INK, false);
        }
        let legend = self.legend(&svg.font, size[0]);
        legend.draw(&mut svg, [EDGE, if self.title.is_empty() { 0.0 } else { TITLE_HEIGHT }]);
        for (panel, (at, size)) in self.panels.iter().zip(places) {
            Panel::draw(&mut svg, panel, at, size, !self.has_common_legend);
        }
        let lines = self.caption_lines(&svg.font, size[0]);
        for (place, line) in lines.iter().rev().enumerate() {
            let y = size[1] - BOTTOM - CAPTION_LINE * place as f64;
            svg.text(line, [EDGE, y], CAPTION, Anchor::Start, INK, false);
        }
        svg.finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::figure::{Axis, Dash, Hue, Mark, PointShape};
    use crate::report::image::pixels;

    fn noise(k: usize) -> f64 {
        libm::sin((k * k) as f64) * libm::cos(k as f64 * 1e3)
    }

    fn curve(index: usize, label: &str, values: impl Fn(usize) -> f64) -> Mark {
        let times = (0..1201).map(|k| f64::from(k) * 0.05).collect();
        Mark::line(label, Hue::Curve(index), Dash::of_curve(index), times, (0..1201).map(values).collect())
    }

    fn panel(unit: &str, marks: Vec<Mark>) -> Figure {
        let (time, y) = (Axis::linear("time", "s"), Axis::linear("quantity", unit));
        Figure { is_over_time: true, ..Figure::new("Kinetic energy of the body", time, y, marks) }
    }

    fn sheet(has_common_legend: bool) -> Sheet {
        let names = || Axis::names((0..5).map(|k| format!("initial.angular_velocity_rad_s.{k}")).collect());
        let wave = |size: f64, base: f64| move |k: usize| base + size * libm::sin(0.05 * k as f64);
        let many = (0..12).map(|k| curve(k, &format!("reaction_wheel_number_{k}"), move |_| k as f64)).collect();
        let limits = [1e-10, -1e-10].map(|at| Mark::Limit { label: "tolerance".to_owned(), at, vertical: false });
        let errors = limits.into_iter().chain([curve(0, "energy", |k| 1e-13 * noise(k))]).collect();
        let x: Vec<f64> = (0..=40).map(|k| 1.0 + f64::from(k)).collect();
        let hue = Hue::Body;
        let bars = Mark::Bars { label: "runs".into(), hue, edges: x.clone(), heights: vec![3.0; 40] };
        let far = Mark::Limit { label: "nominal -7".into(), at: -7.0, vertical: true };
        let points =
            |shape, y: Vec<f64>| Mark::Points { label: String::new(), hue, shape, x: x.clone(), y, samples: vec![] };
        let band = Mark::Band {
            label: "5 to 95%".into(),
            hue,
            opacity: 0.5,
            x: x.clone(),
            low: vec![1.0; 41],
            high: x.clone(),
            stacked: false,
        };
        let whiskers = Mark::Whiskers {
            label: "interval".into(),
            hue,
            x: vec![1.0, 2.0, 0.1, 0.2, 0.0],
            low: vec![0.5, f64::NAN, 0.0, 0.0, 0.0],
            high: vec![3.0; 5],
        };
        let log = |marks| Figure::new("Tail", Axis::log("error", ""), Axis::log("fraction of runs", ""), marks);
        let panels = vec![
            panel("J", vec![curve(0, "a", noise), curve(1, "b", |k| 0.5 * noise(k + 7))]),
            panel("J", vec![curve(0, "", wave(80.0, 1_060_915.0))]),
            panel("", errors),
            panel("rad/s", many),
            Figure {
                columns: 3,
                ..Figure::new("x", Axis::linear("", "").within(1.0, 41.0), Axis::linear("", ""), vec![bars, far])
            },
            Figure { columns: 3, ..log(vec![points(PointShape::Disc, x.iter().map(|x| 1e-9 * x * x).collect())]) },
            Figure { columns: 3, ..log(vec![band]) },
            Figure {
                columns: 3,
                ..panel("N m s", vec![points(PointShape::Stem, x.clone()), points(PointShape::Cross, x.clone())])
            },
            Figure::new("Influence", Axis::linear("share", ""), names(), vec![whiskers]),
            Figure::new(
                "Matrix",
                names(),
                names(),
                vec![Mark::Matrix { values: (0..25).map(|k| 0.08 * f64::from(k) - 1.0).collect() }],
            ),
        ];
        Sheet { title: "spin_sweep, nominal".into(), width: 1280.0, panel_height: 320.0, has_common_legend, panels }
    }

    /// Text, place and box of every text of a picture: left, top, right, bottom.
    fn texts(svg: &str) -> Vec<(String, [f64; 2], [f64; 4])> {
        let font = Font::new();
        let numbers =
            |text: &str| text.split([' ', ')']).map_while(|one| one.parse::<f64>().ok()).collect::<Vec<f64>>();
        let of_line = |line: &str| {
            let after = |key: &str| line.split(key).nth(1).unwrap_or_default();
            let text = after("aria-label=\"").split('"').next().unwrap_or_default().to_owned();
            let (at, shift) =
                (numbers(after("transform=\"translate(")), numbers(line.rsplit("translate(").next().unwrap())[0]);
            let size = numbers(after("scale("))[0] * 2048.0;
            let (width, is_upwards) = (font.width(&text, size), line.contains("rotate(-90)"));
            let [x, y] = [at[0], at[1]];
            let edges = match is_upwards {
                true => [x - 0.75 * size, y - shift - width, x + 0.2 * size, y - shift],
                false => [x + shift, y - 0.75 * size, x + shift + width, y + 0.2 * size],
            };
            (text, [x, y], edges)
        };
        svg.lines().filter(|line| line.contains("aria-label")).map(of_line).collect()
    }

    /// Law: no text leaves the picture or meets another, with one legend or one for each panel, also where the size is given. With
    /// SPINDRIFT_PLOT_FOLDER set the picture is kept to be looked at.
    #[test]
    fn texts_do_not_meet() {
        for (has_common_legend, size) in [(false, None), (true, None), (false, Some([1700.0, 1900.0]))] {
            let sheet = sheet(has_common_legend);
            let svg = sheet.svg(size);
            if let Some(folder) = std::env::var_os("SPINDRIFT_PLOT_FOLDER") {
                std::fs::write(std::path::Path::new(&folder).join(format!("sheet_{has_common_legend}.svg")), &svg)
                    .unwrap();
            }
            let ([width, height], _) = sheet.layout(&Font::new(), size);
            let texts = texts(&svg);
            for (index, (text, _, [left, top, right, bottom])) in texts.iter().enumerate() {
                assert!(*left >= 0.0 && *top >= 0.0 && *right <= width && *bottom <= height, "{text}");
                for (other, _, [l, t, r, b]) in &texts[..index] {
                    assert!(right < l || r < left || bottom < t || b < top, "`{text}` and `{other}`, {size:?}");
                }
            }
            assert!(texts.len() > 120 && texts.iter().any(|(text, ..)| text == "reaction_wheel_number_11"));
        }
    }

    /// Law: the points that are drawn are the values, on the scale that the ticks say.
    #[test]
    fn points_are_where_the_ticks_say() {
        let svg = Sheet::of(&panel("J", vec![curve(0, "", |k| 200.0 + 150.0 * noise(k))])).svg(None);
        let line = svg.split("<polyline").find(|one| one.contains("#0072b2")).unwrap();
        let points = line.split("points=\"").nth(1).unwrap().split('"').next().unwrap();
        let pair = |text: &str| text.split_once(',').map(|(x, y)| [x.parse().unwrap(), y.parse().unwrap()]).unwrap();
        let points: Vec<[f64; 2]> = points.split(' ').map(pair).collect();
        let texts = texts(&svg);
        let place = |of: &str| texts.iter().find(|(text, ..)| text == of).unwrap().1;
        let (x20, second) = (place("20")[0], 0.1 * (place("30")[0] - place("20")[0]));
        // letters are 4 pixels below their tick
        let (y200, joule) = (place("200")[1] - 4.0, 0.01 * (place("300")[1] - place("200")[1]));
        assert_eq!(points.len(), 1201);
        for (k, [x, y]) in points.into_iter().enumerate() {
            let known = [x20 + second * (0.05 * k as f64 - 20.0), y200 + joule * 150.0 * noise(k)];
            // coordinates have two decimals
            assert!((x - known[0]).abs() < 0.05 && (y - known[1]).abs() < 0.05, "{k}: {x} {y} {known:?}");
        }
    }

    /// Places of the pixels that are neither grey nor white.
    fn colored(svg: &str) -> Vec<[f64; 2]> {
        let pixmap = pixels(svg, 96.0).unwrap();
        let width = pixmap.width() as usize;
        let is_colored = |color: [u8; 3]| color.iter().max().unwrap() - color.iter().min().unwrap() > 30;
        let found = pixmap.pixels().iter().enumerate().filter(|(_, p)| is_colored([p.red(), p.green(), p.blue()]));
        found.map(|(at, _)| [(at % width) as f64, (at / width) as f64]).collect()
    }

    /// Law: every kind of mark leaves coloured pixels, all of them in its panel, however noisy it is; a picture has a white edge.
    #[test]
    fn marks_stay_in_their_panels() {
        let all = sheet(false);
        let places = all.layout(&Font::new(), None).1;
        for (index, ([x, y], [width, height])) in places.into_iter().enumerate() {
            let mut one = all.clone();
            let others = one.panels.iter_mut().enumerate().filter(|(other, _)| *other != index);
            // bars without height keep their panels as they are
            others.for_each(|(_, panel)| panel.marks.retain(|mark| matches!(mark, Mark::Limit { .. })));
            one.panels[index].columns = all.panels[index].columns;
            let found = colored(&one.svg(None));
            assert!(found.len() > 100, "{index}: {} pixels", found.len());
            let top = one.layout(&Font::new(), None).1[index].0[1];
            let is_inside = |[a, b]: &[f64; 2]| *a > x && *a < x + width && *b > top && *b < top + height.max(y - top);
            assert!(found.iter().all(is_inside), "panel {index}");
        }
        let picture = pixels(&all.svg(None), 96.0).unwrap();
        let (width, height) = (picture.width(), picture.height());
        let is_white = |x: u32, y: u32| picture.pixel(x, y).is_some_and(|p| [p.red(), p.green(), p.blue()] == [255; 3]);
        assert!((0..height).all(|y| is_white(0, y) && is_white(width - 1, y)));
        assert!((0..width).all(|x| is_white(x, 0) && is_white(x, height - 1)));
    }

    /// Law: values that an axis cannot show do no harm.
    #[test]
    fn nothing_to_show_is_drawn() {
        let nothing = Mark::line("", Hue::Body, Dash::Solid, vec![-1.0, f64::NAN], vec![f64::NAN, -2.0]);
        let figure = Figure::new("t", Axis::log("x", ""), Axis::log("y", ""), vec![nothing]);
        let svg = Sheet::of(&figure).svg(Some([80.0, 80.0]));
        assert!(!svg.contains("NaN") && !svg.contains("inf") && colored(&svg).is_empty());
    }
}
