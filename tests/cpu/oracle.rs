//! The definition of the result, by brute force in big integers. It shares nothing with the crate
//! except the sign conventions.
#![allow(dead_code, reason = "every test binary uses a part")]

use num_bigint::{BigInt, Sign};
use std::collections::BTreeMap;

/// Returns the sign as the predicates do.
pub fn sign(value: &BigInt) -> i8 {
    match value.sign() {
        Sign::Minus => -1,
        Sign::NoSign => 0,
        Sign::Plus => 1,
    }
}

/// Returns x·2¹⁰⁷⁴, which is an integer for every finite x.
fn integer(x: f64) -> BigInt {
    assert!(x.is_finite());
    let bits = x.to_bits();
    let (exponent, fraction) = ((bits >> 52) & 0x7ff, bits & ((1 << 52) - 1));
    let magnitude = match exponent {
        0 => BigInt::from(fraction),
        _ => BigInt::from(fraction | 1 << 52) << (exponent - 1),
    };
    if x.is_sign_negative() { -magnitude } else { magnitude }
}

/// Returns the points times a power of two that makes them integers.
pub fn integers<const D: usize>(points: &[[f64; D]]) -> Vec<[BigInt; D]> {
    let integers: Vec<[BigInt; D]> = points.iter().map(|p| p.map(integer)).collect();
    let shift = integers.as_flattened().iter().filter_map(BigInt::trailing_zeros).min().unwrap_or(0);
    integers.into_iter().map(|p| p.map(|x| x >> shift)).collect()
}

/// Returns the determinant of the matrix with these rows, by expansion along its first column.
pub fn determinant(rows: &[Vec<BigInt>]) -> BigInt {
    let [first, rest @ ..] = rows else { return BigInt::from(1) };
    if rest.is_empty() {
        return first[0].clone();
    }
    let minor = |left_out: usize| {
        let others = rows.iter().enumerate().filter(|&(i, _)| i != left_out);
        determinant(&others.map(|(_, row)| row[1..].to_vec()).collect::<Vec<_>>())
    };
    let terms = rows.iter().enumerate().filter(|(_, row)| row[0] != BigInt::ZERO);
    terms.map(|(i, row)| if i % 2 == 0 { &row[0] * minor(i) } else { -&row[0] * minor(i) }).sum()
}

/// Returns the determinant of D + 1 points with a column of ones: twice the area, or six times the
/// volume, positive for positively oriented simplices.
pub fn orientation<const D: usize>(points: &[&[BigInt; D]]) -> BigInt {
    let rows: Vec<_> = points[1..].iter().map(|p| (0..D).map(|i| &p[i] - &points[0][i]).collect()).collect();
    determinant(&rows)
}

/// Returns the squared distance from the origin: the height on the paraboloid.
pub fn height<const D: usize>(p: &[BigInt; D]) -> BigInt {
    p.iter().map(|x| x * x).sum()
}

/// Returns the orientation of D + 2 points without the k-th.
fn without<const D: usize>(points: &[&[BigInt; D]], k: usize) -> BigInt {
    let others: Vec<_> = points.iter().enumerate().filter(|&(i, _)| i != k).map(|(_, p)| *p).collect();
    orientation(&others)
}

/// Returns the derivatives of [`in_circumsphere`] with respect to each point's height: positive
/// where lifting the point brings the last point inside.
fn cofactors<const D: usize>(points: &[&[BigInt; D]]) -> Vec<BigInt> {
    let last = points.len() - 1;
    let signed = |k: usize| if (last - k).is_multiple_of(2) { -without(points, k) } else { without(points, k) };
    (0..points.len()).map(signed).collect()
}

/// Returns a positive number if the last of D + 2 points lies inside the circumsphere of the
/// others, which are positively oriented.
pub fn in_circumsphere<const D: usize>(points: &[&[BigInt; D]]) -> BigInt {
    cofactors(points).iter().zip(points).map(|(cofactor, p)| cofactor * height(p)).sum()
}

/// Returns the sign of [`in_circumsphere`] with the heights of the points perturbed by their
/// indices.
pub fn in_circumsphere_symbolic<const D: usize>(indices: &[u32], points: &[&[BigInt; D]]) -> i8 {
    let cofactors = cofactors(points);
    let value: BigInt = cofactors.iter().zip(points).map(|(cofactor, p)| cofactor * height(p)).sum();
    let by_index: BTreeMap<_, _> = indices.iter().zip(&cofactors).collect();
    let perturbed = by_index.into_values().map(sign);
    std::iter::once(sign(&value)).chain(perturbed).find(|&s| s != 0).unwrap_or(0)
}

/// The expected result of [`gdel::delaunay3d`].
#[derive(Debug, PartialEq, Eq)]
pub struct Definition {
    /// The tetrahedra in the form of [`gdel::Mesh3::canonical`].
    pub tetrahedra: Vec<[u32; 4]>,
    /// See [`gdel::Mesh3::duplicate_of`].
    pub duplicate_of: Vec<u32>,
    /// See [`gdel::Mesh3::dimension`].
    pub dimension: u8,
}

/// Returns the result that the definition names, for some tens of points.
pub fn definition(points: &[[f64; 3]]) -> Definition {
    let points = integers(points);
    let first_equal = |p: &[BigInt; 3]| points.iter().position(|q| p == q).unwrap();
    let representatives: Vec<usize> = points.iter().map(first_equal).collect();
    let duplicate_of =
        representatives.iter().enumerate().map(|(i, &r)| if r == i { gdel::NONE } else { r as u32 }).collect();
    let distinct: Vec<u32> = (0..points.len()).filter(|&i| representatives[i] == i).map(|i| i as u32).collect();
    let point = |i: u32| &points[i as usize];
    let mut tetrahedra = Vec::new();
    let mut solid = false;
    for (i, &a) in distinct.iter().enumerate() {
        for (j, &b) in distinct.iter().enumerate().skip(i + 1) {
            for (k, &c) in distinct.iter().enumerate().skip(j + 1) {
                for &d in &distinct[k + 1..] {
                    let orientation = sign(&orientation(&[point(a), point(b), point(c), point(d)]));
                    solid |= orientation != 0;
                    let empty = |&e: &u32| {
                        let five = [a, b, c, d, e];
                        five[..4].contains(&e) || in_circumsphere_symbolic(&five, &five.map(point)) * orientation < 0
                    };
                    if orientation != 0 && distinct.iter().all(empty) {
                        tetrahedra.push([a, b, c, d]);
                    }
                }
            }
        }
    }
    let dimension = if solid { 3 } else { flat_dimension(&distinct.iter().map(|&i| point(i)).collect::<Vec<_>>()) };
    Definition { tetrahedra, duplicate_of, dimension }
}

/// Returns the affine dimension of distinct points that are coplanar: collinear points are
/// collinear along every axis.
fn flat_dimension(distinct: &[&[BigInt; 3]]) -> u8 {
    let [a, b, others @ ..] = distinct else { return 0 };
    let drop = |p: &[BigInt; 3], axis: usize| [p[(axis + 1) % 3].clone(), p[(axis + 2) % 3].clone()];
    let turns = |p: &&&[BigInt; 3]| {
        (0..3).any(|axis| {
            let [a, b, p] = [a, b, **p].map(|p| drop(p, axis));
            orientation(&[&a, &b, &p]) != BigInt::ZERO
        })
    };
    if others.iter().any(|p| turns(&p)) { 2 } else { 1 }
}

/// The expected result of [`gdel::delaunay2d`].
#[derive(Debug, PartialEq, Eq)]
pub struct Definition2 {
    /// The triangles in the form of [`gdel::Mesh2::canonical`].
    pub triangles: Vec<[u32; 3]>,
    /// See [`gdel::Mesh2::duplicate_of`].
    pub duplicate_of: Vec<u32>,
    /// See [`gdel::Mesh2::dimension`].
    pub dimension: u8,
}

/// Returns the 2D result that the definition names, for some tens of points.
pub fn definition2(points: &[[f64; 2]]) -> Definition2 {
    let points = integers(points);
    let representatives: Vec<usize> = points.iter().map(|p| points.iter().position(|q| p == q).unwrap()).collect();
    let duplicate_of =
        representatives.iter().enumerate().map(|(i, &r)| if r == i { gdel::NONE } else { r as u32 }).collect();
    let distinct: Vec<u32> = (0..points.len()).filter(|&i| representatives[i] == i).map(|i| i as u32).collect();
    let point = |i: u32| &points[i as usize];
    let mut triangles = Vec::new();
    let mut dimension = distinct.len().saturating_sub(1).min(1) as u8;
    for (i, &a) in distinct.iter().enumerate() {
        for (j, &b) in distinct.iter().enumerate().skip(i + 1) {
            for &c in &distinct[j + 1..] {
                let orientation = sign(&orientation(&[point(a), point(b), point(c)]));
                let empty = |&d: &u32| {
                    let four = [a, b, c, d];
                    four[..3].contains(&d) || in_circumsphere_symbolic(&four, &four.map(point)) * orientation < 0
                };
                if orientation != 0 {
                    dimension = 2;
                    if distinct.iter().all(empty) {
                        triangles.push([a, b, c]);
                    }
                }
            }
        }
    }
    Definition2 { triangles, duplicate_of, dimension }
}

/// The expected result of [`gdel::Triangulator::regular3d`] or `regular2d`.
#[derive(Debug, PartialEq, Eq)]
pub struct Regular<const N: usize> {
    /// The simplices in the form of `canonical`.
    pub simplices: Vec<[u32; N]>,
    /// See [`gdel::Mesh3::duplicate_of`].
    pub duplicate_of: Vec<u32>,
    /// See [`gdel::Mesh3::hidden`].
    pub hidden: Vec<u32>,
}

/// Returns points and weights as integers: times a power of two, and times its square.
fn weighted_integers<const D: usize>(points: &[[f64; D]], weights: &[f64]) -> (Vec<[BigInt; D]>, Vec<BigInt>) {
    let mut points: Vec<[BigInt; D]> = points.iter().map(|p| p.map(integer)).collect();
    // The coordinates have been multiplied by 2¹⁰⁷⁴.
    let mut weights: Vec<BigInt> = weights.iter().map(|&w| integer(w) << 1074).collect();
    let shift = points.as_flattened().iter().filter_map(BigInt::trailing_zeros).min().unwrap_or(0);
    let shift = weights.iter().filter_map(BigInt::trailing_zeros).map(|zeros| zeros / 2).fold(shift, u64::min);
    points.as_flattened_mut().iter_mut().for_each(|x| *x >>= shift);
    weights.iter_mut().for_each(|w| *w >>= 2 * shift);
    (points, weights)
}

/// Returns the result that the definition names, for about ten points, with `N` = `D` + 1.
pub fn regular<const D: usize, const N: usize>(points: &[[f64; D]], weights: &[f64]) -> Regular<N> {
    let (points, weights) = weighted_integers(points, weights);
    // Of equal points, the heaviest; of equal weights, the first.
    let stands_for = |i: usize| {
        let equal = (0..points.len()).filter(|&j| points[j] == points[i]);
        equal.max_by(|&j, &k| weights[j].cmp(&weights[k]).then(k.cmp(&j))).unwrap()
    };
    let duplicate_of: Vec<u32> =
        (0..points.len()).map(|i| if stands_for(i) == i { gdel::NONE } else { stands_for(i) as u32 }).collect();
    let distinct: Vec<u32> = (0..points.len() as u32).filter(|&i| duplicate_of[i as usize] == gdel::NONE).collect();
    let point = |i: u32| &points[i as usize];
    let lifted = |i: u32| height(point(i)) - &weights[i as usize];
    // Positive if the last point is below the others, which are positively oriented.
    let is_below = |all: &[u32]| {
        let cofactors = cofactors(&all.iter().map(|&i| point(i)).collect::<Vec<_>>());
        let value: BigInt = cofactors.iter().zip(all).map(|(cofactor, &i)| cofactor * lifted(i)).sum();
        let by_index: BTreeMap<_, _> = all.iter().zip(&cofactors).collect();
        let perturbed = by_index.into_values().map(sign);
        std::iter::once(sign(&value)).chain(perturbed).find(|&s| s != 0).unwrap_or(0)
    };
    let mut simplices = Vec::new();
    for simplex in combinations::<N>(&distinct) {
        let orientation = sign(&orientation(&simplex.map(point)));
        let is_above = |&i: &u32| {
            let all = [&simplex[..], &[i]].concat();
            simplex.contains(&i) || is_below(&all) * orientation < 0
        };
        if orientation != 0 && distinct.iter().all(is_above) {
            simplices.push(simplex);
        }
    }
    let is_hidden = |i: &u32| !simplices.is_empty() && !simplices.as_flattened().contains(i);
    let hidden = distinct.iter().copied().filter(is_hidden).collect();
    Regular { simplices, duplicate_of, hidden }
}

/// Returns all ascending lists of `N` of the items.
fn combinations<const N: usize>(items: &[u32]) -> Vec<[u32; N]> {
    let mut lists = vec![Vec::new()];
    for _ in 0..N {
        let longer = |list: &Vec<u32>| {
            let list = list.clone();
            let from = list.last().map_or(0, |last| items.iter().position(|i| i == last).unwrap() + 1);
            items[from..].iter().map(move |&i| [&list[..], &[i]].concat()).collect::<Vec<_>>()
        };
        lists = lists.iter().flat_map(longer).collect();
    }
    lists.into_iter().map(|list| list.try_into().unwrap()).collect()
}
