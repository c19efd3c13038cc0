import { triangulated } from '../../triangulated.mjs';

export const load = async () => ({ server: await triangulated() });
