import { triangulated } from '../triangulated.mjs';
import Client from './client';

export const dynamic = 'force-dynamic';

export default async function Page() {
  return (
    <main>
      <p id="server">{JSON.stringify(await triangulated())}</p>
      <Client />
    </main>
  );
}
