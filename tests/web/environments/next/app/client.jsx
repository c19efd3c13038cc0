'use client';

import { useEffect, useState } from 'react';
import { triangulated } from '../triangulated.mjs';

export default function Client() {
  const [text, setText] = useState('');
  useEffect(() => {
    triangulated().then((found) => setText(JSON.stringify(found)));
  }, []);
  return <p id="client">{text}</p>;
}
