// Of what tests/Precompiled.h compiles.
int main() {}
