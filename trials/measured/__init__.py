"""The trial on measured records: effects injected by software, blocks taken out of models, published causes withheld."""
