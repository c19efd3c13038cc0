import { triangulated } from './triangulated.mjs';

const out = document.createElement('p');
out.id = 'client';
document.body.append(out);
triangulated().then((found) => {
  out.textContent = JSON.stringify(found);
});
