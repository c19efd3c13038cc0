// Stands before the package's main file in frames of examples, in place of imports of its own files: modules of texts
// have no folder. A frame and its workers have nothing in common but such a channel, whose other end is in boot.mjs.

// biome-ignore lint/correctness/noUnusedVariables: what it is put before uses it.
const partOf = (name) =>
  new Promise((resolve) => {
    const channel = new BroadcastChannel('gdel-parts');
    channel.onmessage = ({ data }) => {
      if (data.name !== name) return;
      channel.close();
      const text = new Blob([data.text], { type: 'text/javascript' });
      resolve(import(URL.createObjectURL(text)));
    };
    channel.postMessage({ wanted: name });
  });
