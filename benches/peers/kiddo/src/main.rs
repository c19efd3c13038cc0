//! Nearest neighbours by kiddo's immutable tree: `kiddo-nearest POINTS QUERIES`.

use kiddo::{SquaredEuclidean, immutable::float::kdtree::ImmutableKdTree};

fn read(path: &str) -> Vec<[f64; 3]> {
    let bytes = std::fs::read(path).expect("a file of points");
    let numbers: Vec<f64> = bytes.chunks_exact(8).map(|x| f64::from_le_bytes(x.try_into().unwrap())).collect();
    numbers.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect()
}

/// Returns the time that this thread has run.
fn cpu_seconds() -> f64 {
    let schedstat = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap();
    schedstat.split(' ').next().unwrap().parse::<f64>().unwrap() * 1e-9
}

fn main() {
    let paths: Vec<String> = std::env::args().skip(1).collect();
    let [points, queries] = [&paths[0], &paths[1]].map(|path| read(path));
    let start = cpu_seconds();
    let tree: ImmutableKdTree<f64, u32, 3, 32> = ImmutableKdTree::new_from_slice(&points);
    println!("{{\"name\": \"tree\", \"cpu_seconds\": {:.6}}}", cpu_seconds() - start);
    let start = cpu_seconds();
    let nearest: Vec<u32> = queries.iter().map(|query| tree.nearest_one::<SquaredEuclidean>(query).item).collect();
    println!("{{\"name\": \"nearest\", \"cpu_seconds\": {:.6}}}", cpu_seconds() - start);
    let sum = (0u64..).zip(&nearest).fold(0u64, |sum, (i, &j)| {
        let pair = i << 32 | u64::from(j);
        let mixed = (pair ^ pair >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        sum.wrapping_add(mixed ^ mixed >> 32)
    });
    println!("{{\"name\": \"nearest\", \"checksum\": \"{sum:016x}\"}}");
}
