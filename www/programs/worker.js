// A worker of your own blocks nothing but itself. There, functions that do not wait are the fastest.
// In a project, its text is a file with an ordinary import:
// new Worker(new URL('./pipeline.js', import.meta.url), { type: 'module' })
const pipeline = `
const loading = import('${import.meta.resolve('gdel-wasm')}');

onmessage = async ({ data: { runs, size } }) => {
  const { delaunay3dSync, load3d } = await loading;
  await load3d();
  const start = performance.now();
  let tetrahedra = 0;
  // Many small meshes, such as of the neighbourhoods in a simulation.
  for (let run = 0; run < runs; run++) {
    const points = new Float64Array(3 * size).map(Math.random);
    tetrahedra += delaunay3dSync(points).tetrahedra.length / 4;
  }
  postMessage({ runs, tetrahedra, milliseconds: performance.now() - start });
};`;
const url = URL.createObjectURL(new Blob([pipeline], { type: 'text/javascript' }));
const worker = new Worker(url);

document.body.innerHTML = `<p></p><button>Triangulate again</button>
  <p><progress></progress> This moves as long as nothing blocks the page.</p>`;
const [note, button] = document.body.children;

function ask() {
  button.disabled = true;
  note.textContent = 'The worker works…';
  return new Promise((resolve) => {
    worker.onmessage = ({ data: { runs, tetrahedra, milliseconds } }) => {
      const each = (milliseconds / runs).toFixed(2);
      note.textContent = `${runs} meshes with ${tetrahedra} tetrahedra took ${each} ms each`;
      button.disabled = false;
      resolve();
    };
    worker.postMessage({ runs: 500, size: 100 });
  });
}
button.onclick = ask;
await ask();
