// Arguments of indirect dispatches.

/// Workgroups in two dimensions, each within what every device has (65535); group_index() numbers them.
uvec3 groups_for(uint count) {
  uint rows = (count + 65534u) / 65535u;
  return uvec3(rows == 0u ? 0u : (count + rows - 1u) / rows, max(rows, 1u), 1u);
}
