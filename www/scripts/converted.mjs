/** Returns a picture in another size and format, converted by a browser. */
export async function converted(browser, png, width, height, type, quality) {
  const page = await browser.newPage();
  const data = await page.evaluate(
    async ([png, width, height, type, quality]) => {
      const image = await createImageBitmap(await (await fetch(png)).blob(), {
        resizeWidth: width,
        resizeHeight: height,
        resizeQuality: 'high',
      });
      const canvas = Object.assign(document.createElement('canvas'), { width, height });
      canvas.getContext('2d').drawImage(image, 0, 0);
      return canvas.toDataURL(type, quality);
    },
    [`data:image/png;base64,${png.toString('base64')}`, width, height, type, quality],
  );
  await page.close();
  return Buffer.from(data.split(',')[1], 'base64');
}
