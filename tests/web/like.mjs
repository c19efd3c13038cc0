/** Returns an object that is like another, but for some members. Tests run it in pages and workers. */
export function like(object, members) {
  return new Proxy(object, {
    get(target, key) {
      const value = members[key] ?? target[key];
      return typeof value === 'function' ? value.bind(target) : value;
    },
  });
}
