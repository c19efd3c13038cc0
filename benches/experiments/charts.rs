//! Charts as SVG.

use plotters::{
    coord::{
        Shift,
        ranged1d::{AsRangedCoord, ValueFormatter},
    },
    prelude::*,
};
use std::{error::Error, path::Path};

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// A chart.
pub enum Chart {
    Lines(Lines),
    Bars(Bars),
}

/// One line a series, over a horizontal axis that begins at 0.
pub struct Lines {
    pub name: &'static str,
    pub title: String,
    pub x: &'static str,
    pub y: &'static str,
    /// Whether the vertical axis is logarithmic.
    pub logarithmic: bool,
    pub series: Vec<(String, Vec<(f64, f64)>)>,
}

/// One bar a group, of one part a series, stacked.
pub struct Bars {
    pub name: &'static str,
    pub title: String,
    pub y: &'static str,
    pub groups: Vec<String>,
    /// The name of each part, and its height in each group.
    pub parts: Vec<(String, Vec<f64>)>,
}

const SIZE: (u32, u32) = (900, 540);

impl Chart {
    /// Returns its name among those of the experiment.
    pub fn name(&self) -> &'static str {
        match self {
            Chart::Lines(lines) => lines.name,
            Chart::Bars(bars) => bars.name,
        }
    }

    pub fn write(&self, path: &Path) -> Result<(), Box<dyn Error>> {
        let area = SVGBackend::new(path, SIZE).into_drawing_area();
        area.fill(&WHITE)?;
        match self {
            Chart::Lines(lines) => lines.draw(&area)?,
            Chart::Bars(bars) => bars.draw(&area)?,
        }
        area.present()?;
        Ok(())
    }
}

fn color(series: usize) -> RGBAColor {
    Palette99::pick(series).to_rgba()
}

impl Lines {
    fn draw(&self, area: &Area<'_>) -> Result<(), Box<dyn Error>> {
        let all = || self.series.iter().flat_map(|(_, points)| points);
        let most = |of: fn(&(f64, f64)) -> f64| all().map(of).fold(0.0, f64::max);
        let (right, top) = (most(|p| p.0) * 1.03, most(|p| p.1) * 1.05);
        if self.logarithmic {
            // No logarithm of 0: such points lie on the axis.
            let least = all().map(|p| p.1).filter(|y| *y > 0.0).min_by(f64::total_cmp).unwrap_or(1.0);
            self.draw_on(area, right, (least / 2.0..top.max(least) * 2.0).log_scale(), least / 2.0)
        } else {
            self.draw_on(area, right, 0.0..top, 0.0)
        }
    }

    fn draw_on<Y>(&self, area: &Area<'_>, right: f64, y: Y, bottom: f64) -> Result<(), Box<dyn Error>>
    where
        Y: AsRangedCoord<Value = f64>,
        Y::CoordDescType: ValueFormatter<f64>,
    {
        let mut chart = ChartBuilder::on(area)
            .caption(&self.title, ("sans-serif", 20))
            .margin(12)
            .x_label_area_size(44)
            .y_label_area_size(72)
            .build_cartesian_2d(0.0..right, y)?;
        chart.configure_mesh().x_desc(self.x).y_desc(self.y).draw()?;
        for (i, (name, points)) in self.series.iter().enumerate() {
            let points: Vec<(f64, f64)> = points.iter().map(|&(x, y)| (x, y.max(bottom))).collect();
            chart.draw_series(points.iter().map(|&point| Circle::new(point, 3, color(i).filled())))?;
            chart
                .draw_series(LineSeries::new(points, color(i).stroke_width(2)))?
                .label(name)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color(i).stroke_width(2)));
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperLeft)
            .background_style(WHITE.mix(0.8))
            .draw()?;
        Ok(())
    }
}

impl Bars {
    fn draw(&self, area: &Area<'_>) -> Result<(), Box<dyn Error>> {
        let height = |g: usize| self.parts.iter().map(|(_, heights)| heights[g]).sum::<f64>();
        let top = (0..self.groups.len()).map(height).fold(0.0, f64::max) * 1.05;
        let mut chart = ChartBuilder::on(area)
            .caption(&self.title, ("sans-serif", 20))
            .margin(12)
            .x_label_area_size(44)
            .y_label_area_size(72)
            .build_cartesian_2d((0..self.groups.len()).into_segmented(), 0.0..top)?;
        let label = |at: &SegmentValue<usize>| match at {
            SegmentValue::CenterOf(g) => self.groups.get(*g).cloned().unwrap_or_default(),
            _ => String::new(),
        };
        chart
            .configure_mesh()
            .disable_x_mesh()
            .x_labels(self.groups.len())
            .x_label_formatter(&label)
            .y_desc(self.y)
            .draw()?;
        for (i, (name, heights)) in self.parts.iter().enumerate() {
            let bar = |(g, height): (usize, &f64)| {
                let below = self.parts[..i].iter().map(|(_, heights)| heights[g]).sum::<f64>();
                let corners = [(SegmentValue::Exact(g), below), (SegmentValue::Exact(g + 1), below + height)];
                let mut bar = Rectangle::new(corners, color(i).filled());
                bar.set_margin(0, 0, 24, 24);
                bar
            };
            chart
                .draw_series(heights.iter().enumerate().map(bar))?
                .label(name)
                .legend(move |(x, y)| Rectangle::new([(x, y - 5), (x + 12, y + 5)], color(i).filled()));
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperLeft)
            .background_style(WHITE.mix(0.8))
            .draw()?;
        Ok(())
    }
}
