use crate::motions;
use gdel::{
    Backend, Points2, Points3, Triangulator,
    internals::{
        Options,
        cpu::{edit::edit, update::Limits},
    },
};
use std::{num::NonZeroUsize, time::Instant};

macro_rules! time {
    ($D:literal, $N:literal, $delaunay:ident, $points:ident, $n:expr) => {{
        let t = Triangulator::new().backend(Backend::Cpu).threads(NonZeroUsize::MIN);
        let n: usize = $n;
        let all = motions::uniform::<$D>(n + n / 4, 1);
        let start = Instant::now();
        let mesh = t.$delaunay(&all[..n]).unwrap();
        println!("{}D {n}: from scratch {:.1} ms", $D, start.elapsed().as_secs_f64() * 1e3);
        let options = Options { threads: Some(NonZeroUsize::MIN), ..Options::default() };
        for k in [1, 10, 100, n / 100, n / 32, n / 16, n / 8, n / 4] {
            let mut copy = mesh.clone();
            let start = Instant::now();
            assert!(
                edit::<$D, $N>(&mut copy, $points::from(&all[..n + k]), &[], &options, Limits::NONE).unwrap().is_none()
            );
            let inserted = start.elapsed().as_secs_f64() * 1e3;
            let mut copy = mesh.clone();
            let removed: Vec<u32> = (0..k as u32).map(|i| (i as u64 * 7919 % n as u64) as u32).collect();
            let start = Instant::now();
            assert!(
                edit::<$D, $N>(&mut copy, $points::from(&all[..n]), &removed, &options, Limits::NONE)
                    .unwrap()
                    .is_none()
            );
            println!("  {k}: inserted {inserted:.2} ms, removed {:.2} ms", start.elapsed().as_secs_f64() * 1e3);
        }
    }};
}

#[test]
#[ignore]
fn timing() {
    for n in [10_000, 100_000, 1_000_000] {
        time!(3, 4, delaunay3d, Points3, n);
        time!(2, 3, delaunay2d, Points2, n);
    }
}
