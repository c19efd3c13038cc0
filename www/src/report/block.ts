// The report as one block of text, which crates/gdel-cli writes in the same form and scripts/devices.mjs
// reads; and its address.

/** What came of the test. */
export type Outcome = 'right' | 'incomplete' | 'WRONG';

/** The most characters of an address that are looked at. */
const MAX_LENGTH = 20_000;

const RANKS: readonly Outcome[] = ['right', 'incomplete', 'WRONG'];

/** Returns the worse of two outcomes. */
export const worse = (a: Outcome, b: Outcome): Outcome =>
  RANKS.indexOf(a) < RANKS.indexOf(b) ? b : a;

/** Returns milliseconds for people. */
export const shown = (milliseconds: number): string =>
  `${milliseconds.toFixed(milliseconds < 9.95 ? 1 : 0)} ms`;

/** Returns what the browser is called, with its version. */
export function browserName(userAgent: string): string {
  const names: [string, RegExp][] = [
    ['Edge', /Edg(?:A|iOS)?\/(\d+)/],
    ['Samsung Internet', /SamsungBrowser\/(\d+)/],
    ['Opera', /OPR\/(\d+)/],
    ['Firefox', /(?:Firefox|FxiOS)\/(\d+)/],
    ['Chromium', /(?:Chrome|CriOS)\/(\d+)/],
    ['Safari', /Version\/(\d+(?:\.\d+)?).*Safari/],
  ];
  for (const [name, pattern] of names) {
    const version = pattern.exec(userAgent)?.[1];
    if (version) return `${name} ${version}`;
  }
  return 'another browser';
}

/** Returns the system and what runs it, as far as the browser tells. */
export function systemName({ userAgent, hardwareConcurrency }: Navigator): string {
  const systems: [string, RegExp][] = [
    ['android', /Android/],
    ['ios', /iPhone|iPad|iPod/],
    ['windows', /Windows/],
    ['macos', /Mac OS X/],
    ['chromeos', /CrOS/],
    ['linux', /Linux/],
  ];
  const name = systems.find(([, pattern]) => pattern.test(userAgent))?.[0] ?? 'another system';
  return `${name}, ${hardwareConcurrency} threads`;
}

/** Returns the block that the part of an address after # holds; null if there is none. */
export function blockOf(hash: string): string | null {
  if (hash.length < 2 || hash.length > MAX_LENGTH) return null;
  try {
    const text = decodeURIComponent(hash.slice(1));
    return text.startsWith('gdel report ') ? text : null;
  } catch {
    return null;
  }
}

/** Returns what follows # in the address of a block. */
export const hashOf = (block: string): string => encodeURIComponent(block);

/** Returns the address that files a block as an issue. */
export function issueOf(repository: string, block: string): string {
  const device = /^device: (.*)$/m.exec(block)?.[1] ?? '';
  const parameters = new URLSearchParams({
    title: `Device report: ${device}`,
    body: `\`\`\`text\n${block}\n\`\`\`\n`,
  });
  return `${repository}/issues/new?${parameters}`;
}
