// The columns that a layer's steps work on, packed: software devices run whole vectors of threads.
layout(std430, binding = kSweepSelectedColumnsBinding) readonly buffer SelectedColumns { SelectedColumn selected_columns[]; };
