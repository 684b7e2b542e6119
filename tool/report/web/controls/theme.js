/** Light or dark, as the reader's system is, until the button changes it. */

const system = () => window.matchMedia?.('(prefers-color-scheme: dark)');

export const initialTheme = () => (system()?.matches ? 'dark' : 'light');

export function followTheme(store) {
  const apply = ({ theme }) => {
    document.documentElement.dataset.theme = theme;
  };
  apply(store.get());
  store.on(['theme'], apply);
  let chosen = false;
  system()?.addEventListener?.('change', (event) => {
    if (!chosen) store.set({ theme: event.matches ? 'dark' : 'light' });
  });
  return {
    toggle() {
      chosen = true;
      store.set({ theme: store.get().theme === 'dark' ? 'light' : 'dark' });
    },
  };
}
