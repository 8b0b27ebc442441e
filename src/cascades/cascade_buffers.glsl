// Cascades by address.
#include "scene/scene_buffers.glsl"
#include "cascades/cascade_types.shared.h"

layout(buffer_reference, scalar, buffer_reference_align = 8) buffer Table { CascadeTable v; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Arguments { CascadeArguments v; };
UMB_ARRAY(States, CascadeState, 4);
UMB_ARRAY(CascadeItems, CascadeItem, 4);
UMB_ARRAY(GridTriangles, GridTriangle, 4);

/// First word of a cascade's static map `which`; of its working map with which = 2.
uint map_words(Table table, uint cascade, uint which) { return which * table.v.texels + table.v.records[cascade].first_texel; }

/// First word of a cascade's cells: maps are made of whole ones.
uint cell_words(Table table, uint cascade) { return table.v.records[cascade].first_texel / (CellTexels * CellTexels); }
