    for (i = 0; i < (@NAME@_HISTORY - 1) * @NAME@_FEATURES; i++)
        state->past[i] = state->past[i + @NAME@_FEATURES];
    for (i = 0; i < @NAME@_FEATURES; i++)
        state->past[(@NAME@_HISTORY - 1) * @NAME@_FEATURES + i] = features[i];
    state->seen += state->seen < @NAME@_HISTORY;
    return @name@_ready(state) ? @name@_window(state->past) : 0.0f;
