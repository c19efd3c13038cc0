// How the tests start browsers: Debian's, or those that CHROMIUM and FIREFOX name. Where there is neither, Chromium is
// Playwright's: the whole one, since its shell without windows has SwiftShader in place of the GPU.

import { chromium, firefox } from 'playwright-core';

const QUIET = [
  '--no-sandbox',
  '--disable-quic',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
];

/** WebGPU, on the software adapter that Chromium has everywhere; with GDEL_REAL_GPU, on the machine's GPU. */
export const WEBGPU = process.env.GDEL_REAL_GPU
  ? ['--enable-unsafe-webgpu', '--ignore-gpu-blocklist']
  : ['--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader'];

/** The same with SwiftShader's Vulkan, without which headless Chromium cannot show what WebGPU draws. */
export const WEBGPU_DRAWING = [
  ...WEBGPU,
  '--enable-features=Vulkan',
  '--use-vulkan=swiftshader',
  '--use-angle=vulkan',
];

/** The same beside WebGL, where a driver of the machine would be Vulkan's without SwiftShader's own WebGL. */
export const WEBGPU_AND_WEBGL = [...WEBGPU_DRAWING.slice(0, -1), '--use-angle=swiftshader'];

// A file of tests that hangs gets SIGTERM, which Playwright takes for a wish to close the browsers
// only. When the process exits, it kills those that are left.
process.once('SIGTERM', () => process.exit(1));

const { CHROMIUM = process.platform === 'linux' ? '/usr/bin/chromium' : undefined } = process.env;

export function launchChromium(flags = []) {
  return chromium.launch({
    ...(CHROMIUM ? { executablePath: CHROMIUM } : { channel: 'chromium' }),
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
