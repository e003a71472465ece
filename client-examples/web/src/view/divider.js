const STEP = 0.02;

/**
 * The line between before and after. It is dragged, or moved by the arrow keys, Home and End.
 * @param {HTMLElement} handle role separator; stands at the custom property --split of its parent
 * @param {(share: number) => void} moved
 */
export function make_divider(handle, moved) {
    const area = handle.parentElement;
    let share = 0.5;

    function move_to(wanted) {
        share = Math.min(0.98, Math.max(0.02, wanted));
        const percent = Math.round(share * 100);
        area.style.setProperty('--split', `${share * 100}%`);
        handle.setAttribute('aria-valuenow', percent);
        handle.setAttribute('aria-valuetext', `${percent} % before, ${100 - percent} % after`);
        moved(share);
    }

    handle.addEventListener('pointerdown', (event) => {
        handle.setPointerCapture(event.pointerId);
        event.preventDefault();
        handle.focus();
    });
    handle.addEventListener('pointermove', (event) => {
        if (!handle.hasPointerCapture(event.pointerId)) return;
        const box = area.getBoundingClientRect();
        move_to((event.clientX - box.left) / box.width);
    });
    handle.addEventListener('keydown', (event) => {
        const wanted = { ArrowLeft: share - STEP, ArrowRight: share + STEP, PageUp: share + 0.1,
            PageDown: share - 0.1, Home: 0, End: 1 }[event.key];
        if (wanted === undefined) return;
        event.preventDefault();
        move_to(wanted);
    });
    move_to(share);
}
