import { triangulated } from '../../../triangulated.mjs';

export const dynamic = 'force-dynamic';

export async function GET() {
  return Response.json(await triangulated());
}
