"""What gyrify costs, alone and beside other libraries: ``python benchmarks``."""
