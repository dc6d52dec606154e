    return m, src, rim
