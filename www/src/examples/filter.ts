/** Shows the examples about one subject, or all. */
const group = document.querySelector<HTMLElement>('.subjects')!;
const buttons = [...group.querySelectorAll('button')];

for (const button of buttons)
  button.addEventListener('click', () => {
    for (const other of buttons) other.ariaPressed = String(other === button);
    for (const item of document.querySelectorAll<HTMLElement>('.pictures li'))
      item.hidden = button !== buttons[0] && item.dataset.subject !== button.textContent;
  });
group.hidden = false;
