// A small E57 file, since no npm package writes one.

/** The checksum of a page: CRC-32C. */
function checksum(page) {
  let crc = ~0;
  for (const byte of page) {
    crc ^= byte;
    for (let bit = 0; bit < 8; bit++) crc = (crc >>> 1) ^ (crc & 1 ? 0x82f63b78 : 0);
  }
  return ~crc >>> 0;
}

/** A scan of points in single precision, each with a state: 0, or 2 where it has no return. */
export function e57(points, states) {
  const columns = [0, 1, 2].map((axis) => Float32Array.from(points, (point) => point[axis]));
  const streams = [...columns.map((column) => Buffer.from(column.buffer)), Buffer.from(states)];
  const sizes = Buffer.from(Uint16Array.from(streams, (stream) => stream.length).buffer);
  const packet = Buffer.concat([Buffer.alloc(6), sizes, ...streams]);
  const padding = Buffer.alloc(-packet.length & 3);
  packet.writeUInt8(1, 0);
  packet.writeUInt16LE(packet.length + padding.length - 1, 2);
  packet.writeUInt16LE(streams.length, 4);
  const section = Buffer.alloc(32);
  section.writeUInt8(1, 0);
  section.writeBigUInt64LE(80n, 16);

  const axes = ['X', 'Y', 'Z'].map((x) => `<cartesian${x} type="Float" precision="single"/>`);
  const state = '<cartesianInvalidState type="Integer" minimum="0" maximum="255"/>';
  const xml = Buffer.from(
    `<?xml version="1.0" encoding="UTF-8"?>
<e57Root type="Structure" xmlns="http://www.astm.org/COMMIT/E57/2010-e57-v1.0">
<formatName type="String">ASTM E57 3D Imaging Data File</formatName>
<guid type="String">file</guid>
<versionMajor type="Integer">1</versionMajor><versionMinor type="Integer">0</versionMinor>
<data3D type="Vector" allowHeterogeneousChildren="1"><vectorChild type="Structure">
<points type="CompressedVector" fileOffset="48" recordCount="${points.length}">
<prototype type="Structure">${axes.join('')}${state}</prototype>
</points></vectorChild></data3D></e57Root>`,
  );
  const start = 48 + section.length + packet.length + padding.length;
  const header = Buffer.alloc(48);
  header.write('ASTM-E57');
  header.writeUInt32LE(1, 8);
  const content = Buffer.concat([header, section, packet, padding, xml]);
  const pages = Math.ceil(content.length / 1020);
  const inFile = (at) => BigInt(at + 4 * Math.floor(at / 1020));
  content.writeBigUInt64LE(BigInt(1024 * pages), 16);
  content.writeBigUInt64LE(inFile(start), 24);
  content.writeBigUInt64LE(BigInt(xml.length), 32);
  content.writeBigUInt64LE(1024n, 40);
  const file = Buffer.alloc(1024 * pages);
  for (let page = 0; page < pages; page++) {
    content.copy(file, 1024 * page, 1020 * page, 1020 * (page + 1));
    const data = file.subarray(1024 * page, 1024 * page + 1020);
    file.writeUInt32BE(checksum(data), 1024 * page + 1020);
  }
  return file;
}
