// The slider: drag over the picture, or use the range below it by mouse or keyboard.
document.documentElement.classList.add('js');
for (const wipe of document.querySelectorAll('.wipe')) {
  const pair = wipe.querySelector('.pair');
  const range = wipe.querySelector('input');
  const show = () => {
    pair.style.setProperty('--at', range.value + '%');
    range.setAttribute('aria-valuetext', range.value + ' % model, ' + (100 - range.value) + ' % forest');
  };
  const follow = (event) => {
    const box = pair.getBoundingClientRect();
    range.value = Math.round(100 * (event.clientX - box.left) / box.width);
    show();
  };
  pair.addEventListener('pointerdown', (event) => {
    pair.setPointerCapture(event.pointerId);
    follow(event);
  });
  pair.addEventListener('pointermove', (event) => {
    if (pair.hasPointerCapture(event.pointerId)) follow(event);
  });
  pair.addEventListener('dragstart', (event) => event.preventDefault());
  range.addEventListener('input', show);
  show();
}
// Paper has no folds to open.
addEventListener('beforeprint', () => document.querySelectorAll('details').forEach((d) => { d.open = true; }));
