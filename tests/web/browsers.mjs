// How the tests start browsers: Debian's, or those that CHROMIUM and FIREFOX name.

import { chromium, firefox } from 'playwright-core';

const QUIET = [
  '--no-sandbox',
  '--disable-quic',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
];

/** WebGPU, on the software adapter that Chromium has everywhere. */
export const WEBGPU = ['--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader'];

/** The same with SwiftShader's Vulkan, without which headless Chromium cannot show what WebGPU draws. */
export const WEBGPU_DRAWING = [
  ...WEBGPU,
  '--enable-features=Vulkan',
  '--use-vulkan=swiftshader',
  '--use-angle=vulkan',
];

// A file of tests that hangs gets SIGTERM, which Playwright takes for a wish to close the browsers
// only. When the process exits, it kills those that are left.
process.once('SIGTERM', () => process.exit(1));

export function launchChromium(flags = []) {
  return chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: [...QUIET, ...flags],
  });
}

/**
 * Mozilla's own build, through WebDriver BiDi: the channel tells Playwright not to look for its
 * patched one.
 */
export function launchFirefox() {
  return firefox.launch({
    channel: 'moz-firefox',
    executablePath: process.env.FIREFOX ?? '/usr/bin/firefox-esr',
  });
}
