// Drives the page as a visitor does.

/**
 * How long a page may take for one thing before it counts as hung. No machine needs nearly as long.
 */
const HANG = 300_000;

/**
 * Opens the page and waits for the first drawing. Collects the errors that the page does not
 * handle, and the paths of all files that it loads.
 */
export async function open(browser, url, { hang = HANG, ...options } = {}, prepare = () => {}) {
  // A context of its own: axe needs one, and no visit sees what another left.
  const context = await browser.newContext({
    viewport: { width: 1440, height: 900 },
    // Half as many pixels each way: software draws most of the time that the tests take.
    deviceScaleFactor: 0.5,
    colorScheme: 'light',
    // The cut that opens a new object takes its time.
    reducedMotion: 'reduce',
    // Keeping the page for visits without a connection fetches all of it.
    serviceWorkers: 'block',
    ...options,
  });
  await prepare(context);
  const page = await context.newPage();
  page.setDefaultTimeout(hang);
  page.problems = [];
  page.files = new Set();
  page.on('response', (response) => page.files.add(new URL(response.url()).pathname));
  page.on('pageerror', (error) => page.problems.push(error.stack ?? error.message));
  page.on('console', (message) => message.type() === 'error' && page.problems.push(message.text()));
  await page.goto(url);
  await settled(page);
  await unfold(page);
  return page;
}

/** Shows what the panel of points has folded away. */
export async function unfold(page) {
  for (const fold of await page.locator('.fold').all())
    await fold.evaluate((details) => (details.open = true));
}

/**
 * Waits until the page has done what it was asked to do: what it says and what it draws belong to
 * the last request. Handlers of events mark the page as busy before they return, so this can be
 * called right after an event.
 */
export async function settled(page) {
  await page.locator('#stage[aria-busy="false"]').waitFor({ state: 'attached' });
}

/**
 * Waits for a condition on something that does not make the page busy: its address, a chart, the
 * live mode. Asks by the clock, because a page that has nothing to draw gets no frames.
 */
export async function until(page, condition, argument) {
  await page.waitForFunction(condition, argument, { polling: 50 });
}

/** The numbers in a text, without their commas. */
export const numbers = (text) =>
  (text.match(/\d[\d,.]*/g) ?? []).map((n) => Number(n.replaceAll(',', '')));

export const text = (page, id) => page.locator(`#${id}`).textContent();

/** How many simplices are shown, and of how many. */
export async function shown(page) {
  const found = numbers(await text(page, 'shown'));
  return { shown: found[0], total: found.at(-1) };
}

export async function tab(page, name) {
  await page.click(`#tab-${name}`);
}

/** Sets a slider as a visitor's hand does. */
export async function slide(page, id, value) {
  await page.locator(`#${id}`).evaluate((slider, value) => {
    slider.value = String(value);
    slider.dispatchEvent(new Event('input', { bubbles: true }));
  }, value);
  await settled(page);
}

/** Chooses a radio button, whose own box is not to be seen. */
export async function choose(page, name, value) {
  await page.locator(`input[name="${name}"][value="${value}"]`).evaluate((radio) => radio.click());
  await settled(page);
}

/** Asks the panel for generated points, without waiting for them. */
export async function request(page, distribution, points) {
  await tab(page, 'points');
  await page.selectOption('#distribution', distribution);
  await page.fill('#number', String(points));
  await page.click('#generator button[type=submit]');
}

/** Generates points with a given backend, through the panel. */
export async function generate(page, distribution, points, { backend = 'auto' } = {}) {
  await tab(page, 'points');
  if (!(await page.isChecked(`input[name=backend][value=${backend}]`)))
    await choose(page, 'backend', backend);
  await request(page, distribution, points);
  await settled(page);
}

/** Drops a file on the page. */
export function drop(page, name, bytes) {
  return dropAll(page, { [name]: bytes });
}

/** Drops files on the page together: their contents by name. */
export async function dropAll(page, contents) {
  const files = Object.entries(contents).map(([name, bytes]) => ({
    name,
    base64: Buffer.from(bytes).toString('base64'),
  }));
  const transfer = await page.evaluateHandle((files) => {
    const transfer = new DataTransfer();
    for (const { name, base64 } of files)
      transfer.items.add(new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], name));
    return transfer;
  }, files);
  await page.dispatchEvent('#stage', 'dragover', { dataTransfer: transfer });
  await page.dispatchEvent('#stage', 'drop', { dataTransfer: transfer });
  await settled(page);
}

/**
 * Waits for `work` and until the page shows a picture of the next mesh. Returns the times on the page's clock at which
 * `work` began, the page told the size of the mesh, and the picture was there. The page may go on to open the mesh slowly.
 */
export async function nextPicture(page, work) {
  await page.evaluate(() => {
    globalThis.picture = new Promise((resolve) => {
      const times = { began: performance.now() };
      const observe = (id, options, seen) => {
        const observer = new MutationObserver(() => seen(observer));
        observer.observe(document.getElementById(id), options);
      };
      observe('count', { childList: true, characterData: true, subtree: true }, () => {
        times.meshed ??= performance.now();
      });
      observe('stage', { attributeFilter: ['data-cut'] }, (observer) => {
        if (times.meshed === undefined) return;
        observer.disconnect();
        requestAnimationFrame(() =>
          requestAnimationFrame(() => resolve({ ...times, shown: performance.now() })),
        );
      });
    });
  });
  await work();
  return page.evaluate(() => globalThis.picture);
}
