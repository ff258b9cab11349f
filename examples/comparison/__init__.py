"""Problems with known answers, every method run on each, and the peers it is compared with."""
