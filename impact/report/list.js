// The list of a page, a batch at a time as the reader comes to its end. drawn: the elements of an item, given the item
// before it too. What is returned shows other items from the start.
function listOf(batch, drawn) {
  let items = [];
  let shown = 0;
  function more() {
    const fragment = document.createDocumentFragment();
    for (const end = Math.min(shown + batch, items.length); shown < end; shown += 1) fragment.append(...drawn(items[shown], items[shown - 1]));
    at("list").append(fragment);
    at("next").hidden = shown >= items.length;
  }
  at("next").addEventListener("click", more);
  new IntersectionObserver((entries) => { if (entries.some((entry) => entry.isIntersecting)) more(); }, { rootMargin: "600px" }).observe(at("next"));
  return (others) => {
    items = others;
    shown = 0;
    at("list").replaceChildren();
    more();
  };
}

// Calls update whenever the filters change.
function filterWith(update) {
  at("filters").addEventListener("input", update);
  at("filters").addEventListener("submit", (event) => event.preventDefault());
  at("filters").addEventListener("reset", () => setTimeout(update));
}
