// Empty: the target that compiles Precompiled.h has to have a source.
