"""The pictures of the documents, one module each; `scripts/make_pictures.py` draws them."""
