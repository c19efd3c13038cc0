import { mount } from 'svelte';
import { compile } from 'svelte/compiler';

// In a project, this text is a file Cells.svelte, and the build compiles it.
const component = `
<script>
  import { delaunay2d } from 'gdel-wasm';

  const box = [0, 0, 720, 440];
  const somewhere = () => [box[2] * Math.random(), box[3] * Math.random()];
  let points = $state.raw(Array.from({ length: 24 }, somewhere));
  let relaxed = $state(0);
  let voronoi = $state.raw(null);

  $effect(() => {
    const of = points;
    delaunay2d(of)
      .then((mesh) => mesh.voronoi({ clip: box }))
      .then((found) => {
        // Only the last points count.
        if (of === points) voronoi = found;
      });
  });

  function relax() {
    relaxed++;
    points = points.map((_, i) => [voronoi.centroids[2 * i], voronoi.centroids[2 * i + 1]]);
  }
</script>

<p>{points.length} points, moved {relaxed} times to the centres of their cells.</p>
<button onclick={relax}>Move them</button>
<svg viewBox={box.join(' ')} stroke="white" stroke-width="2">
  {#each voronoi?.cellPolygons() ?? [] as cell}
    <polygon points={cell.join(' ')} fill="hsl({cell.index * 137.5} 50% 65%)" />
  {/each}
  {#each points as [cx, cy]}
    <circle {cx} {cy} r="4" fill="#222" />
  {/each}
</svg>`;

const { js } = compile(component, { name: 'Cells' });
const module = URL.createObjectURL(new Blob([js.code], { type: 'text/javascript' }));
const { default: Cells } = await import(/* @vite-ignore */ module);
mount(Cells, { target: document.body });
