//! The colours and normals of points, from what a file says about each.

/// The origin of the colours of points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColorSource {
    /// Colours that the file has.
    Rgb,
    /// Intensity of the returned light: shades of grey from the 2nd to the 98th percentile.
    Intensity,
    /// Directions of the surface: *x*, *y* and *z* from −1 to 1 as red, green and blue.
    Normals,
}

impl ColorSource {
    /// Returns the name: `rgb`, `intensity` or `normals`.
    pub fn name(self) -> &'static str {
        match self {
            ColorSource::Rgb => "rgb",
            ColorSource::Intensity => "intensity",
            ColorSource::Normals => "normals",
        }
    }
}

/// The colours of the points of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct PointColors {
    /// Red, green and blue of each point, in sRGB.
    pub rgb: Vec<[u8; 3]>,
    /// The origin of the colours.
    pub source: ColorSource,
}

/// Numbers that a file may have for the colour of a point.
pub(super) const CHANNELS: usize = 7;

/// Red, green, blue, intensity, and the three components of a normal; NaN where a point has none.
pub(super) type Sample = [f64; CHANNELS];

/// The place of the intensity in a sample.
pub(super) const INTENSITY: usize = 3;
/// The place of the normal in a sample.
pub(super) const NORMAL: usize = 4;

/// Returns the place in a sample of the column or property with a name.
pub(super) fn channel(name: &[u8]) -> Option<usize> {
    const NAMES: [&[&str]; CHANNELS] = [
        &["red", "r", "diffuse_red"],
        &["green", "g", "diffuse_green"],
        &["blue", "b", "diffuse_blue"],
        &["intensity", "scalar_intensity", "reflectance"],
        &["nx", "normal_x"],
        &["ny", "normal_y"],
        &["nz", "normal_z"],
    ];
    NAMES.iter().position(|names| names.iter().any(|known| name.eq_ignore_ascii_case(known.as_bytes())))
}

/// The range of the numbers that stand for red, green and blue.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Range {
    /// From 0 to 255.
    Bytes,
    /// From 0 to 65,535, or to 255 if none is larger: not all programs keep to the format.
    Words,
    /// From 0 to 1, or to 255 if any is larger than 1.
    Fractions,
}

impl Range {
    /// Factor that converts numbers to 16-bit integers.
    fn scale(self) -> f64 {
        if self == Range::Fractions { 256.0 } else { 1.0 }
    }

    /// Returns the integer that stands for full light, given the largest of all.
    fn full(self, largest: u16) -> f64 {
        match self {
            Range::Bytes => 255.0,
            Range::Words => {
                if largest > 255 {
                    65_535.0
                } else {
                    255.0
                }
            }
            Range::Fractions => {
                if largest > 256 {
                    255.0 * 256.0
                } else {
                    256.0
                }
            }
        }
    }
}

/// Gathers the colours of points, one after the other.
pub(super) struct Colors {
    range: Range,
    rgb: Option<Vec<[u16; 3]>>,
    intensities: Option<Vec<f32>>,
    /// Of length 1, or zero where one is unknown.
    normals: Option<Vec<[f32; 3]>>,
}

impl Colors {
    /// Creates it without points; `has` says which numbers of a sample the file has.
    pub(super) fn new(has: [bool; CHANNELS], range: Range) -> Self {
        let all = |places: std::ops::Range<usize>| has[places].iter().all(|&has| has);
        Colors {
            range,
            rgb: all(0..3).then(Vec::new),
            intensities: has[INTENSITY].then(Vec::new),
            normals: all(NORMAL..CHANNELS).then(Vec::new),
        }
    }

    /// Returns whether the file has no number that colours come from.
    pub(super) fn is_empty(&self) -> bool {
        self.rgb.is_none() && self.intensities.is_none() && self.normals.is_none()
    }

    /// Adds a point.
    #[inline]
    pub(super) fn push(&mut self, sample: &Sample) {
        let [r, g, b, intensity, normal @ ..] = *sample;
        if let Some(rgb) = &mut self.rgb {
            rgb.push([r, g, b].map(|x| nearest(x * self.range.scale())));
        }
        if let Some(intensities) = &mut self.intensities {
            intensities.push(if intensity.is_finite() { intensity as f32 } else { 0.0 });
        }
        if let Some(normals) = &mut self.normals {
            let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
            let unit = if length > 0.0 && length.is_finite() { normal.map(|x| x / length) } else { [0.0; 3] };
            normals.push(unit.map(|x| x as f32));
        }
    }

    /// Returns the normals, unless all are unknown.
    pub(super) fn take_normals(&mut self) -> Option<Vec<[f32; 3]>> {
        self.normals.take().filter(|normals| normals.iter().any(|normal| *normal != [0.0; 3]))
    }

    /// Returns the colours, else the intensities, else the normals. Values that are equal for all
    /// points are ignored.
    pub(super) fn finish(&self) -> Option<PointColors> {
        fn varied<T: PartialEq>(values: Option<&Vec<T>>) -> Option<&Vec<T>> {
            values.filter(|values| values.iter().any(|value| *value != values[0]))
        }
        let colors = |rgb, source| Some(PointColors { rgb, source });
        if let Some(rgb) = varied(self.rgb.as_ref()) {
            let full = self.range.full(rgb.iter().flatten().copied().max().unwrap_or_default());
            let byte = |x: u16| nearest(255.0 * f64::from(x) / full).min(255) as u8;
            return colors(rgb.iter().map(|color| color.map(byte)).collect(), ColorSource::Rgb);
        }
        if let Some(intensities) = varied(self.intensities.as_ref()) {
            return colors(greys(intensities), ColorSource::Intensity);
        }
        let normals = varied(self.normals.as_ref())?;
        let color = |normal: &[f32; 3]| normal.map(|x| nearest(127.5 + 127.5 * f64::from(x)) as u8);
        colors(normals.iter().map(color).collect(), ColorSource::Normals)
    }
}

/// Returns the nearest integer, the first or last of its type for what is out of its range, and 0
/// for NaN. `f64::round` is a call of the mathematical library on most targets.
fn nearest(x: f64) -> u16 {
    (x + 0.5) as u16
}

/// Returns shades of grey from the 2nd to the 98th percentile of values that are not all the same.
fn greys(values: &[f32]) -> Vec<[u8; 3]> {
    /// Number of values that the percentiles are estimated from.
    const SAMPLE: usize = 1 << 16;
    let mut sample: Vec<f32> = values.iter().copied().step_by(values.len() / SAMPLE + 1).collect();
    sample.sort_unstable_by(f32::total_cmp);
    let at = |percent: usize| sample[(sample.len() - 1) * percent / 100];
    let (mut low, mut high) = (at(2), at(98));
    if low == high {
        low = values.iter().copied().fold(f32::INFINITY, f32::min);
        high = values.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    }
    let grey =
        |x: f32| nearest(255.0 * (f64::from(x) - f64::from(low)) / (f64::from(high) - f64::from(low))).min(255) as u8;
    values.iter().map(|&x| [grey(x); 3]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const NONE: Sample = [f64::NAN; CHANNELS];

    fn gathered(range: Range, samples: &[Sample]) -> Option<PointColors> {
        let has = std::array::from_fn(|k| samples.iter().any(|sample| !sample[k].is_nan()));
        let mut colors = Colors::new(has, range);
        samples.iter().for_each(|sample| colors.push(sample));
        colors.finish()
    }

    fn rgb(r: f64, g: f64, b: f64) -> Sample {
        let mut sample = NONE;
        sample[..3].copy_from_slice(&[r, g, b]);
        sample
    }

    fn intensity(value: f64) -> Sample {
        let mut sample = NONE;
        sample[INTENSITY] = value;
        sample
    }

    #[test]
    fn ranges_are_told_by_their_largest_number() {
        for (range, white, grey) in [
            (Range::Bytes, 255.0, 51.0),
            (Range::Words, 255.0, 51.0),
            (Range::Words, 65_535.0, 13_107.0),
            (Range::Fractions, 1.0, 0.2),
            (Range::Fractions, 255.0, 51.0),
        ] {
            let colors = gathered(range, &[rgb(white, 0.0, white), rgb(grey, white, f64::NAN)]).expect("two colours");
            assert_eq!(colors.rgb, [[255, 0, 255], [51, 255, 0]], "up to {white}");
            assert_eq!(colors.source, ColorSource::Rgb);
        }
    }

    #[test]
    fn numbers_out_of_range_are_the_nearest_in_it() {
        let colors = gathered(Range::Bytes, &[rgb(-5.0, 300.0, f64::INFINITY), rgb(0.0, 0.0, 0.0)]);
        assert_eq!(colors.expect("two colours").rgb, [[0, 255, 255], [0, 0, 0]]);
    }

    #[test]
    fn what_is_the_same_everywhere_says_nothing() {
        let mut black = [rgb(0.0, 0.0, 0.0); 3];
        assert_eq!(gathered(Range::Bytes, &black), None);
        for (k, sample) in black.iter_mut().enumerate() {
            sample[INTENSITY] = 7.0;
            sample[NORMAL..].copy_from_slice(&[0.0, 0.0, k as f64 - 1.0]);
        }
        let colors = gathered(Range::Bytes, &black).expect("normals");
        assert_eq!(colors.source, ColorSource::Normals);
        assert_eq!(colors.rgb, [[128, 128, 0], [128, 128, 128], [128, 128, 255]]);
        black[0][INTENSITY] = 8.0;
        assert_eq!(gathered(Range::Bytes, &black).expect("intensities").source, ColorSource::Intensity);
        assert_eq!(gathered(Range::Bytes, &[]), None);
        assert_eq!(gathered(Range::Bytes, &[NONE; 2]), None);
    }

    #[test]
    fn intensities_are_stretched_and_a_few_bright_ones_do_not_count() {
        let mut samples: Vec<Sample> = (0..100).map(|i| intensity(f64::from(i))).collect();
        samples.push(intensity(1e30));
        samples.push(intensity(f64::INFINITY));
        let greys = gathered(Range::Bytes, &samples).expect("intensities").rgb;
        assert!(greys[50].iter().all(|&grey| (120..136).contains(&grey)), "{:?}", greys[50]);
        assert_eq!(greys[100], [255; 3]);
        // All but one are the same.
        let mut samples = vec![intensity(1.0); 1000];
        samples[3] = intensity(2.0);
        let greys = gathered(Range::Bytes, &samples).expect("intensities").rgb;
        assert_eq!((greys[3], greys[4]), ([255; 3], [0; 3]));
    }

    #[test]
    fn columns_have_these_names() {
        for (name, place) in [("R", 0), ("diffuse_blue", 2), ("scalar_Intensity", 3), ("NX", 4), ("normal_z", 6)] {
            assert_eq!(channel(name.as_bytes()), Some(place), "{name}");
        }
        assert_eq!(channel(b"x"), None);
    }
}
