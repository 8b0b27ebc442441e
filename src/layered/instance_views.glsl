// One instance a view: which caster and which view an instance is.

/// The n-th view of the group that sees the caster.
uint nth_view(uint caster, uint n) {
  if (!each_view) return push.first_view + n;
  uint view = push.first_view;
  for (uint end = push.first_view + push.view_count; view < end; ++view)
    if (sees(push.visible, caster, view) && n-- == 0u) break;
  return view;
}
