/** The address of the folder with the demo page, in which all others are. */
export const ROOT = new URL(document.querySelector<HTMLAnchorElement>('.wordmark')?.href ?? './');
