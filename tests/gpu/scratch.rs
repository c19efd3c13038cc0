use gdel::internals::input::lattice::Width;
use gdel::internals::reference::d3::predicates::Vertex;
use gdel::internals::reference::run::{Settings, run};
use gdel::internals::d3::mesh::FACETS;
use gdel::internals::predicates::integer::orient3d_narrow;
type State = gdel::internals::reference::State<3>;

fn show(state: &State) {
    for t in (0..state.simplices.len() as u32).filter(|&t| state.is_used(t as usize)) {
        let tet = state.corners(t);
        for k in 0..4 {
            let (u, face) = state.across(t, k);
            let e = state.corners(u)[face];
            if u < t || !state.inside(tet, e) { continue; }
            let p = |v: u32| if v == state.params.infinite { "inf".to_string() } else { format!("{:?}", state.points[v as usize].position) };
            let x = FACETS[k].map(|c| tet[c]);
            let negative: Vec<usize> = (0..3).filter(|&i| state.orient([x[i], x[(i + 1) % 3], tet[k], e]) < 0).collect();
            let deg: Vec<usize> = negative.iter().map(|&i| { let ends = [x[i], x[(i+1)%3]]; state.simplices.iter().filter(|tet| ends.iter().all(|v| tet.contains(v))).count() }).collect();
            println!("facet {:?} apexes {} {} negative {negative:?} degrees {deg:?}", x.map(p), p(tet[k]), p(e));
        }
    }
    for t in (0..state.simplices.len() as u32).filter(|&t| state.is_used(t as usize)) {
        let tet = state.corners(t);
        if tet.contains(&state.params.infinite) { continue; }
        let [a,b,c,d] = tet.map(|v| state.points[v as usize].position);
        if orient3d_narrow(a,b,c,d) == 0 { println!("flat {:?}", [a,b,c,d]); }
    }
}

#[test]
fn scratch() {
    let grid = |[a, b, c]: [i64; 3]| -> Vec<[i64;3]> {
        (0..a * b * c).map(|i| [i % a, i / a % b, i / (a * b)].map(|x| 4 * x)).collect()
    };
    for shape in [[3,2,2],[4,2,2],[5,2,2],[6,2,2],[7,2,2],[8,2,2],[10,2,2],[12,2,2],[3,3,2],[4,4,2],[5,5,2],[6,6,2],[8,8,2],[4,4,4],[6,6,6]] {
        for order in 0..3 {
            let points = grid(shape);
            let n = points.len() as u64;
            let sites: Vec<Vertex> = points.iter().enumerate().map(|(i, &position)| {
                let i = i as u64;
                let index = match order { 0 => i, 1 => n - 1 - i, _ => (i * 7919) % 100003 } as u32;
                Vertex { position, index }
            }).collect();
            let state = run(Width::Narrow, sites, &Settings { validate: true, ..Settings::default() }).unwrap();
            let bad = state.validate_end();
            println!("{shape:?} order {order}: bad {bad} rounds {} iterations {}", state.counters.round, state.counters.iterations);
            if bad > 0 && n < 40 { show(&state); }
        }
    }
}
