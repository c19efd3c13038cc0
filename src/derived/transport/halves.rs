//! Sites from which the weights of given areas are found in few steps: where treemaps begin.
//!
//! A convex polygon is halved by mass again and again, until each part has one mass. The parts have the right areas, and
//! the Voronoi cells of their centres come nearer to these than equal ones. Neighbours in the list become neighbours in the
//! plane, and little changes where masses change little. Cuts are turned a little, since straight ones would make
//! grids.

use crate::geometry::vector::{cross2d, dot, minus, plus, times};

/// How far a cut may be turned: the tangent of the angle.
const TURN: f64 = 0.6;

/// Returns a site within a convex polygon, whose corners come in order, for each of the masses, which are positive.
///
/// # Examples
///
/// ```
/// let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
/// let sites = gdel::internals::derived::sites_by_halves(&square, &[3.0, 1.0, 2.0]);
/// assert_eq!(sites.len(), 3);
/// assert!(sites.iter().flatten().all(|&x| x > 0.0 && x < 1.0));
/// ```
pub fn sites_by_halves(corners: &[[f64; 2]], masses: &[f64]) -> Vec<[f64; 2]> {
    let mut sums = vec![0.0];
    sums.extend(masses.iter().scan(0.0, |sum, mass| {
        *sum += mass;
        Some(*sum)
    }));
    let mut sites = vec![[0.0; 2]; masses.len()];
    if corners.is_empty() {
        return sites;
    }
    let mut pending = vec![(corners.to_vec(), 0..masses.len())];
    while let Some((part, range)) = pending.pop() {
        if range.len() < 2 {
            range.for_each(|i| sites[i] = centroid(&part));
            continue;
        }
        // Where the sum is nearest to a half.
        let half = sums[range.start] / 2.0 + sums[range.end] / 2.0;
        let after = range.start + 1 + sums[range.start + 1..range.end].partition_point(|&sum| sum < half);
        let is_before = after == range.end || (after - 1 > range.start && half - sums[after - 1] <= sums[after] - half);
        let middle = if is_before { after - 1 } else { after };
        let share = (sums[middle] - sums[range.start]) / (sums[range.end] - sums[range.start]);
        let [one, other] = cut(&part, direction(&part, noise(middle)), share);
        pending.push((one, range.start..middle));
        pending.push((other, middle..range.end));
    }
    sites
}

/// The sides of a polygon.
fn sides(corners: &[[f64; 2]]) -> impl Iterator<Item = ([f64; 2], [f64; 2])> {
    corners.iter().zip(corners.iter().cycle().skip(1)).map(|(&a, &b)| (a, b))
}

/// Returns the centre of mass of a polygon; if it is flat, that of its corners.
fn centroid(corners: &[[f64; 2]]) -> [f64; 2] {
    let Some(&first) = corners.first() else { return [0.0; 2] };
    // Relative to a corner, so that large offsets do no harm.
    let (mut area, mut moment, mut sum) = (0.0, [0.0; 2], [0.0; 2]);
    for (a, b) in sides(corners) {
        let (a, b) = (minus(a, first), minus(b, first));
        area += cross2d(a, b);
        moment = plus(moment, times(cross2d(a, b), plus(a, b)));
        sum = plus(sum, a);
    }
    let center = times(1.0 / (3.0 * area), moment);
    if center.iter().all(|x| x.is_finite()) {
        plus(first, center)
    } else {
        plus(first, times(1.0 / corners.len() as f64, sum))
    }
}

/// Returns the direction in which a polygon is longest, turned by a part of [`TURN`] from −1 to 1.
fn direction(corners: &[[f64; 2]], turn: f64) -> [f64; 2] {
    let (mut longest, mut most) = ([1.0, 0.0], 0.0);
    for (i, &a) in corners.iter().enumerate() {
        for &b in &corners[..i] {
            let between = minus(a, b);
            let squared = dot(between, between);
            if squared > most {
                (longest, most) = (between, squared);
            }
        }
    }
    let [x, y] = longest;
    let turned = [x - TURN * turn * y, y + TURN * turn * x];
    times(1.0 / dot(turned, turned).sqrt(), turned)
}

/// Returns a number from −1 to 1 for each integer (the finaliser of MurmurHash3).
fn noise(i: usize) -> f64 {
    let mut h = (i as u32).wrapping_add(1).wrapping_mul(0x9e37_79b9);
    h = (h ^ (h >> 16)).wrapping_mul(0x85eb_ca6b);
    h = (h ^ (h >> 13)).wrapping_mul(0xc2b2_ae35);
    f64::from((h ^ (h >> 16)) as i32) / f64::from(1u32 << 31)
}

/// Returns the two parts of a convex polygon that a line across a direction makes, the first with a share of the area.
/// Between the heights of two corners that follow each other, the width is linear.
fn cut(corners: &[[f64; 2]], along: [f64; 2], share: f64) -> [Vec<[f64; 2]>; 2] {
    let mut heights: Vec<f64> = corners.iter().map(|&corner| dot(corner, along)).collect();
    heights.sort_by(f64::total_cmp);
    let slabs = || heights.windows(2).map(|pair| [pair[0], pair[1]]);
    let areas: Vec<f64> = slabs()
        .map(|[low, high]| (high - low) * (width_at(corners, along, low) + width_at(corners, along, high)) / 2.0)
        .collect();
    let mut left = share * areas.iter().sum::<f64>();
    let mut level = heights[0];
    for ([low, high], area) in slabs().zip(&areas) {
        level = high;
        if *area < left {
            left -= area;
            continue;
        }
        let [width, next] = [low, high].map(|level| width_at(corners, along, level));
        // width · s + (next − width) / (high − low) · s² / 2 = left
        let root = (width * width + 2.0 * left * (next - width) / (high - low)).max(0.0).sqrt();
        let thickness = 2.0 * left / (width + root);
        level = if thickness.is_finite() { (low + thickness).min(high) } else { low };
        break;
    }
    [below(corners, along, level), below(corners, times(-1.0, along), -level)]
}

/// Returns how long a line across a direction is within a convex polygon.
fn width_at(corners: &[[f64; 2]], along: [f64; 2], level: f64) -> f64 {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    let mut add = |place: f64| {
        low = low.min(place);
        high = high.max(place);
    };
    for (a, b) in sides(corners) {
        let (from, to) = (dot(a, along) - level, dot(b, along) - level);
        if from == 0.0 {
            add(cross2d(along, a));
        }
        if (from < 0.0 && to > 0.0) || (from > 0.0 && to < 0.0) {
            add(cross2d(along, plus(a, times(from / (from - to), minus(b, a)))));
        }
    }
    (high - low).max(0.0)
}

/// Returns the part of a convex polygon below a level.
fn below(corners: &[[f64; 2]], along: [f64; 2], level: f64) -> Vec<[f64; 2]> {
    let mut part = Vec::with_capacity(corners.len() + 1);
    for (a, b) in sides(corners) {
        let (from, to) = (dot(a, along) - level, dot(b, along) - level);
        if from <= 0.0 {
            part.push(a);
        }
        if (from < 0.0 && to > 0.0) || (from > 0.0 && to < 0.0) {
            part.push(plus(a, times(from / (from - to), minus(b, a))));
        }
    }
    part
}
